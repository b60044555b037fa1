// What is remembered over a reload, in this tab only. A browser that forbids it, or a spoilt entry, is like none.

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
        // It will be forgotten.
    }
}
