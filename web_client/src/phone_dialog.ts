// The dialog that shows the link to the session as a QR code, so that a phone can take part in the session.

import type { Client, Credentials } from "@oval4d/protocol";
import { correction, generate } from "lean-qr";
import { toSvgPath } from "lean-qr/extras/svg";

import { Dialog } from "./dialog";
import { byId } from "./element";
import { isOwnComputer, shareLink } from "./link";

const kQuietZone = 4; // modules of white around the code, without which readers may not find it (ISO/IEC 18004)

export class PhoneDialog {
    private readonly dialog = new Dialog("phone");
    private readonly code = document.querySelector<SVGSVGElement>("#phone-code")!;
    private readonly link = byId<HTMLTextAreaElement>("phone-link");
    private readonly copyButton = byId("phone-copy");
    private readonly status = byId("phone-status");

    constructor(private readonly client: Client) {
        this.link.addEventListener("focus", () => this.link.select());
        this.copyButton.addEventListener("click", () => void this.copy());
    }

    /** Opens the dialog, if there is a session. */
    open(): void {
        const { credentials } = this.client;
        if (!credentials) return;
        this.status.textContent = "";
        const loopback = byId("phone-loopback");
        loopback.hidden = !isOwnComputer(location.hostname);
        loopback.querySelector("b")!.textContent = location.hostname;
        this.showLink(credentials);
        this.dialog.open(this.copyButton);
    }

    /** Shows the link to a session that has replaced the one of the open dialog. */
    update(credentials: Credentials): void {
        if (this.dialog.isOpen) this.showLink(credentials);
    }

    private showLink(credentials: Credentials): void {
        const link = shareLink(credentials);
        if (link === this.link.value) return;
        this.link.value = link;
        const code = generate(link, { minCorrectionLevel: correction.M });
        const side = String(code.size + 2 * kQuietZone);
        this.code.setAttribute("viewBox", `${-kQuietZone} ${-kQuietZone} ${side} ${side}`);
        this.code.querySelector("path")!.setAttribute("d", toSvgPath(code));
    }

    /** Copies the link. If the browser forbids this, as on pages without HTTPS, selects it so that the user can. */
    private async copy(): Promise<void> {
        try {
            await navigator.clipboard.writeText(this.link.value);
            this.status.textContent = "Link copied.";
        } catch {
            this.link.focus();
            this.link.select();
            this.status.textContent = "The link is selected: copy it with Ctrl-C, or Cmd-C on a Mac.";
        }
    }
}
