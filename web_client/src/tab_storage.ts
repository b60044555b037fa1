// Values that survive a reload of the page, but are visible in this tab only (sessionStorage).

/** Returns the value; undefined if there is none, if the entry is invalid, or if the browser forbids storage. */
export function readStored<T>(key: string): T | undefined {
    try {
        return (JSON.parse(sessionStorage.getItem(key) ?? "null") as T | null) ?? undefined;
    } catch {
        return undefined;
    }
}

export function writeStored(key: string, value: unknown): void {
    try {
        sessionStorage.setItem(key, JSON.stringify(value));
    } catch {
        // Storage is not available: the value is lost at a reload.
    }
}
