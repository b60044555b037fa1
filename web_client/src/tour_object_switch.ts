// During a step of the tour, shows another object in place of the user's. Restores the user's view after the step.

import type { Client, Command, State } from "@oval4d/protocol";

export class TourObjectSwitch {
    // The user's view before the current step, and the name of the object that the step shows instead.
    private replaced: { view: State; name: string } | undefined;
    private changes: Promise<void> = Promise.resolve(); // the changes run one after another

    /** `request` sends a command that changes the picture. `failed` gets the Error of a failed change. */
    constructor(
        private readonly client: Client,
        private readonly request: (command: Command) => Promise<unknown>,
        private readonly failed: (error: Error) => void,
    ) {}

    /** Shows the catalogue's object with this name. Without a name, restores the user's own view. */
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
