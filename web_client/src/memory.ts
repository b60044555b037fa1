// Values that survive a reload, in this tab only. If the browser forbids storage or an entry is invalid, the value is
// undefined.

export function recall<T>(key: string): T | undefined {
    try {
        return (JSON.parse(sessionStorage.getItem(key) ?? "null") as T | null) ?? undefined;
    } catch {
        return undefined;
    }
}

export function remember(key: string, value: unknown): void {
    try {
        sessionStorage.setItem(key, JSON.stringify(value));
    } catch {
        // Storage is not available: the value is lost at a reload.
    }
}
