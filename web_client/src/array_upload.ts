// Uploads arrays: binary files with the values of 4-D fields. The page does not read them; the server does.

import type { Credentials, Done, ErrorMessage } from "@oval4d/protocol";

import { FileError, sizeText, detectUtf16 } from "./files";

const kTooLarge = 413; // the HTTP status if a proxy or the server refuses a file because of its size
const kMaxReason = 200; // the most characters of a proxy's answer that the page shows as the reason
// Bytes at the start of a file that isBinaryFile() reads; in a file with an array, they include a control character.
const kHeader = 512;

/** Whether a file is binary, not a text. Only the server finds out whether it is an array, and in which format. */
export async function isBinaryFile(file: File): Promise<boolean> {
    const bytes = new Uint8Array(await file.slice(0, kHeader).arrayBuffer());
    if (detectUtf16(bytes)) return false;
    return bytes.some((byte) => byte < 0x20 && !"\t\n\v\f\r".includes(String.fromCharCode(byte)));
}

/**
 * Loads an array into the session under a name. `sent` is called with the fraction that has been sent, from 0 to 1.
 * Rejects with a FileError if the connection is lost, or if the server or a proxy refuses the array; the error then
 * states the reason. `limit` is the greatest size of a file, in bytes, that the server accepts.
 */
export function uploadArray(
    file: File,
    name: string,
    { session, token }: Credentials,
    limit: number,
    sent: (part: number) => void,
): Promise<Done> {
    // XMLHttpRequest is used because fetch() does not report the progress of an upload.
    const request = new XMLHttpRequest();
    const path = `api/v1/sessions/${encodeURIComponent(session)}/fields/${encodeURIComponent(name)}`;
    request.open("PUT", new URL(path, new URL(".", location.href)));
    request.setRequestHeader("Session-Token", token);
    return new Promise((resolve, reject) => {
        const lost = (): void => reject(new FileError("The connection was lost before the file was loaded. Try again."));
        request.upload.onprogress = ({ loaded, total }) => sent(loaded / total);
        request.onerror = request.onabort = lost;
        request.onload = () => {
            const answer = messageIn(request.responseText);
            if (answer?.type === "done") resolve(answer);
            else reject(new FileError(answer?.message ?? uploadRefusalText(request, limit)));
        };
        request.send(file);
    });
}

/**
 * Parses the server's message in an answer. Returns undefined if the answer is another text, such as a proxy's page.
 */
function messageIn(text: string): Done | ErrorMessage | undefined {
    try {
        const message = JSON.parse(text) as Partial<Done | ErrorMessage> | null;
        if (message?.type === "done" || message?.type === "error") return message as Done | ErrorMessage;
    } catch {
        // The text is not JSON.
    }
    return undefined;
}

/**
 * The reason why a file was not loaded, made from an HTTP answer that is not a message of the server. Quotes the answer
 * only if its type is text/plain.
 */
function uploadRefusalText(request: XMLHttpRequest, limit: number): string {
    const isPlain = /^text\/plain\b/i.test(request.getResponseHeader("Content-Type") ?? "");
    const reason = isPlain ? request.responseText.trim().slice(0, kMaxReason) : "";
    const said = `The file was not loaded: the answer was HTTP status ${request.status}${reason && `, ${reason}`}`;
    if (request.status !== kTooLarge) return reason ? said : `${said}. A proxy before the server may have sent it.`;
    const most = Number.isFinite(limit) ? `files up to ${sizeText(limit)}` : "larger files";
    return `${said.replace(/\.$/, "")}. A proxy before the server allows less than this; the server accepts ${most}.`;
}
