// Finds the action of a pressed key. Executes actions of the page here, and sends all other keys to the server.

import type { Command, KeyBinding } from "@oval4d/protocol";

import type { KeyRepeatLimiter } from "./key_repeat_limiter";
import { undoOrRedoOf, isUsedByFocusedControl, strokeFromEvent, strokesOfBinding, type KeyStroke } from "./keys";
import { loadFromStorage, saveToStorage } from "./storage";

const kSingleKeysKey = "oval4d.single_keys"; // key in localStorage: whether keys act without Ctrl

interface KeyActions {
    send: (command: Command) => void;
    /** Called when Escape was pressed outside dialogs. */
    escape: (event: KeyboardEvent) => void;
    /** Executes the action if it is one of the camera; otherwise returns false. */
    camera: (action: string) => boolean;
    /** The actions of the page itself, by their names in the key table. The server does not execute them. */
    page: Readonly<Record<string, () => void>>;
}

export class Keyboard {
    /** The key table; empty before the server has sent it. */
    keys: readonly KeyBinding[] = [];
    private first: KeyStroke | undefined; // the first key of a two-key sequence, before the second key is pressed
    private ended: KeyBinding | undefined; // the two-key sequence that ended with the last key press
    private actsWithoutCtrl = loadFromStorage<boolean>(kSingleKeysKey, true) ?? true;

    constructor(
        private readonly repeatLimiter: KeyRepeatLimiter,
        private readonly actions: KeyActions,
    ) {}

    /** Whether letters, digits and signs act without Ctrl; this browser remembers the choice. */
    get usesSingleKeys(): boolean {
        return this.actsWithoutCtrl;
    }
    set usesSingleKeys(on: boolean) {
        this.actsWithoutCtrl = on;
        saveToStorage(kSingleKeysKey, on, true);
    }

    keydown(event: KeyboardEvent): void {
        if (event.defaultPrevented || document.querySelector("dialog[open]")) return;
        if (event.key === "Escape" && !event.isComposing) {
            this.cancelSequence();
            this.actions.escape(event);
        }
        if (isUsedByFocusedControl(event)) return;
        const action = undoOrRedoOf(event);
        const stroke = strokeFromEvent(event, this.keys);
        const isSecond = action === undefined && stroke !== undefined && this.isSecondOfSequence(stroke, event.repeat);
        const binding = this.keys.find((row) =>
            action ? row.action === action : row.client && !isSecond && row.key === stroke?.key,
        );
        if (!binding && !stroke) return;
        const isSingle = action === undefined && stroke?.key.length === 1 && !stroke.ctrl;
        if (isSingle && !this.usesSingleKeys) return;
        event.preventDefault();
        if (binding) {
            if (!event.repeat) this.ended = undefined;
            this.press(binding, false, event.repeat);
        } else if (stroke) this.type(stroke, event.repeat);
    }

    /**
     * Forgets the first key of a two-key sequence. Must be called when the user does anything but press the second key.
     */
    cancelSequence(): void {
        this.first = undefined;
    }

    /** Executes the action of a key or a button. The page, the camera or the server executes it. */
    press(binding: KeyBinding, inverse: boolean, held: boolean): void {
        this.cancelSequence();
        const act = this.actions.page[binding.action];
        if (act) act();
        else if (this.actions.camera(binding.action)) return;
        else if (held && !this.repeatLimiter.mayRepeat) return;
        else for (const stroke of strokesOfBinding(binding, inverse)) this.send(stroke, false);
    }

    /** Sends a key to the server. A held key repeats only after the picture of its last press has been presented. */
    send(stroke: KeyStroke, held: boolean): void {
        if (held && !this.repeatLimiter.mayRepeat) return;
        this.actions.send({ type: "key", ...stroke });
    }

    /**
     * Whether a typed or held key is the second key of a sequence. A held key stays the second key when Shift is
     * released.
     */
    private isSecondOfSequence({ key, ctrl }: KeyStroke, held: boolean): boolean {
        if (ctrl) return false;
        if (held) return this.ended?.key[1]?.toLowerCase() === key.toLowerCase();
        return this.keys.some((row) => this.first !== undefined && row.key === this.first.key + key);
    }

    /**
     * Sends a typed key. The first key of a two-key sequence is sent together with the second key. While the second key
     * is held, the sequence repeats if its action may repeat; the held key alone does nothing.
     */
    private type(stroke: KeyStroke, held: boolean): void {
        if (held && this.ended) {
            // If Shift is released before the letter, the letter that is still held does nothing.
            if (this.ended.repeats && this.ended.key[1] === stroke.key) this.press(this.ended, false, held);
            return;
        }
        const { first } = this;
        const begins = !stroke.ctrl && this.keys.some(({ key }) => key.length === 2 && key[0] === stroke.key);
        if (begins && held) return; // a held first key does not begin the sequence again
        this.ended = first && !stroke.ctrl ? this.keys.find(({ key }) => key === first.key + stroke.key) : undefined;
        this.first = begins && !this.ended ? stroke : undefined;
        if (first && this.ended) this.send(first, false);
        if (this.ended || !begins) this.send(stroke, held);
    }
}
