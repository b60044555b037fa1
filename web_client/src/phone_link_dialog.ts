// The dialog that shows the link to the session as a QR code. A phone that scans the code joins the session.

import type { Client, Credentials } from "@oval4d/protocol";
import { correction, generate, type Bitmap2D } from "lean-qr";
import { toSvgPath } from "lean-qr/extras/svg";

import { Dialog } from "./dialog";
import { byId } from "./element";
import { isOwnComputer, serverTokenOfAddress, shareLink } from "./link";

const kQuietZone = 4; // white modules around the code; without them, readers may not find it (ISO/IEC 18004)
const kTooMuchData = 4; // lean-qr's error code for a text that is too long for any QR code

export class PhoneLinkDialog {
    private readonly dialog = new Dialog("phone");
    private readonly code = document.querySelector<SVGSVGElement>("#phone-code")!;
    private readonly tooLong = byId("phone-too-long");
    private readonly link = byId<HTMLTextAreaElement>("phone-link");
    private readonly addsToken = byId<HTMLInputElement>("phone-adds-token");
    private readonly copyButton = byId("phone-copy");
    private readonly status = byId("phone-status");

    constructor(private readonly client: Client) {
        this.link.addEventListener("focus", () => this.link.select());
        this.addsToken.addEventListener("change", () => {
            if (this.client.credentials) this.showLink(this.client.credentials);
        });
        this.copyButton.addEventListener("click", () => void this.copy());
    }

    /** Opens the dialog, if there is a session. */
    open(): void {
        const { credentials } = this.client;
        if (!credentials) return;
        const loopback = byId("phone-loopback");
        loopback.hidden = !isOwnComputer(location.hostname);
        loopback.querySelector("b")!.textContent = location.hostname;
        this.addsToken.checked = false; // off each time, because whoever sees the screen can scan the code
        this.status.textContent = "";
        this.showLink(credentials);
        this.dialog.open(this.copyButton);
        void this.showWhoIsLetIn();
    }

    /** Shows the link to a new session, if the dialog is open. */
    update(credentials: Credentials): void {
        if (this.dialog.isOpen) this.showLink(credentials);
    }

    /** If the server requires its own token, says so, or offers to add the token to the link. */
    private async showWhoIsLetIn(): Promise<void> {
        const isRequired = await requiresToken();
        const isKnown = serverTokenOfAddress() !== undefined;
        byId("phone-locked").hidden = !isRequired || isKnown;
        byId("phone-key").hidden = !isRequired || !isKnown;
    }

    private showLink(credentials: Credentials): void {
        const link = shareLink(credentials, this.addsToken.checked ? serverTokenOfAddress() : undefined);
        if (link === this.link.value) return;
        this.link.value = link;
        this.status.textContent = "";
        const code = qrCodeOf(link);
        this.code.toggleAttribute("hidden", !code);
        this.tooLong.hidden = code !== undefined;
        if (!code) {
            const orShorter = this.addsToken.checked ? ", or leave out the server’s token" : "";
            this.tooLong.textContent =
                `The link is too long for a QR code. Copy it, and send it to the phone${orShorter}.`;
            return;
        }
        const side = String(code.size + 2 * kQuietZone);
        this.code.setAttribute("viewBox", `${-kQuietZone} ${-kQuietZone} ${side} ${side}`);
        this.code.querySelector("path")!.setAttribute("d", toSvgPath(code));
    }

    /**
     * Copies the link. If the browser forbids this, as on pages without HTTPS, selects the link, so that the user can
     * copy it.
     */
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

/**
 * The QR code of a link; undefined if the link is longer than 2331 bytes, the most that a code with correction level M
 * holds.
 */
function qrCodeOf(link: string): Bitmap2D | undefined {
    try {
        return generate(link, { minCorrectionLevel: correction.M });
    } catch (error) {
        if ((error as { code?: number }).code !== kTooMuchData) throw error;
        return undefined;
    }
}

/**
 * Whether the server answers only requests with its own token. By default, it does so on all addresses but loopback.
 */
async function requiresToken(): Promise<boolean> {
    // The request omits the cookie with the token, to see whether the server refuses it. The server counts wrong
    // tokens, but not missing ones. The header WWW-Authenticate tells the server from a proxy that asks for a password.
    const options: RequestInit = { method: "HEAD", credentials: "omit", cache: "no-store" };
    const answer = await fetch(new URL(".", location.href), options).catch(() => undefined);
    return answer?.status === 401 && answer.headers.get("WWW-Authenticate") === "Bearer";
}
