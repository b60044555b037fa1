// Uploads arrays: binary files with the values of 4-D fields. The page does not read them; the server does.

import type { Credentials, Done, ErrorMessage } from "@oval4d/protocol";

import { FileError, utf16Of } from "./files";

const kHeader = 512; // bytes at the start of a file; in an array, they contain a character that texts do not contain

/** Whether a file is binary, not a text. Only the server finds whether it is an array, and in which format. */
export async function isBinary(file: File): Promise<boolean> {
    const bytes = new Uint8Array(await file.slice(0, kHeader).arrayBuffer());
    if (utf16Of(bytes)) return false;
    return bytes.some((byte) => byte < 0x20 && !"\t\n\v\f\r".includes(String.fromCharCode(byte)));
}

/**
 * Loads an array into the session under a name. `sent` is called with the fraction that has been sent, from 0 to 1.
 * Rejects with a FileError if the connection is lost, or, with the server's reason, if the server refuses the array.
 */
export function uploadArray(
    file: File,
    name: string,
    { session, token }: Credentials,
    sent: (part: number) => void,
): Promise<Done> {
    // fetch() does not report progress.
    const request = new XMLHttpRequest();
    const path = `api/v1/sessions/${encodeURIComponent(session)}/fields/${encodeURIComponent(name)}`;
    request.open("PUT", new URL(path, new URL(".", location.href)));
    request.setRequestHeader("Session-Token", token);
    request.responseType = "json";
    return new Promise((resolve, reject) => {
        const lost = (): void => reject(new FileError("The connection was lost before the file was loaded. Try again."));
        request.upload.onprogress = ({ loaded, total }) => sent(loaded / total);
        request.onerror = request.onabort = lost;
        request.onload = () => {
            const answer = request.response as Done | ErrorMessage | null;
            if (answer?.type === "done") resolve(answer);
            else if (answer) reject(new FileError(answer.message));
            else lost();
        };
        request.send(file);
    });
}
