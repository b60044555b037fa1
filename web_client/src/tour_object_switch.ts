// The object that a step of the tour shows in place of the user's, whose view returns after the step.

import type { Client, Command, State } from "@oval4d/protocol";

export class TourObjectSwitch {
    // What the user saw before the step that is shown now, and the name of the object that the step shows instead.
    private replaced: { view: State; name: string } | undefined;
    private changes: Promise<void> = Promise.resolve(); // one after another, however fast the user leaves a step

    /** `request` sends a command that changes the picture; `failed` is called with the Error of a change that fails. */
    constructor(
        private readonly client: Client,
        private readonly request: (command: Command) => Promise<unknown>,
        private readonly failed: (error: Error) => void,
    ) {}

    /** Shows the object of the catalogue with this name, or the user's own view if there is no name. */
    show(name: string | undefined): void {
        this.changes = this.changes.then(() => this.change(name)).catch(this.failed);
    }

    private async change(name: string | undefined): Promise<void> {
        await this.restore();
        if (name === undefined) return;
        const view = await this.client.request({ type: "get", what: "state" });
        await this.request({ type: "set", polytope: name });
        this.replaced = { view, name };
    }

    /** Restores the user's view, unless the user has chosen another object meanwhile. */
    private async restore(): Promise<void> {
        const { replaced } = this;
        this.replaced = undefined;
        if (!replaced) return;
        const { polytope } = await this.client.request({ type: "get", what: "state" });
        if (polytope.name !== replaced.name) return;
        await this.request({ ...replaced.view, type: "set", turning: false, playing: false });
    }
}
