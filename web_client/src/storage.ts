// Values that survive a reload of the page. They are stored for this tab (sessionStorage) or, if `isLasting` is true,
// for all tabs and later visits of this browser (localStorage).

const storageOf = (isLasting: boolean): Storage => (isLasting ? localStorage : sessionStorage);

/**
 * Returns a stored value; undefined if there is none, if the entry is not valid JSON, or if the browser forbids
 * storage.
 */
export function loadFromStorage<T>(key: string, isLasting = false): T | undefined {
    try {
        return (JSON.parse(storageOf(isLasting).getItem(key) ?? "null") as T | null) ?? undefined;
    } catch {
        return undefined;
    }
}

export function saveToStorage(key: string, value: unknown, isLasting = false): void {
    try {
        storageOf(isLasting).setItem(key, JSON.stringify(value));
    } catch {
        // If storage is not available, the value is lost when the page reloads.
    }
}
