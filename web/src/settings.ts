// What a visitor chose is kept for the next visit, where the browser keeps anything.

export interface Remembered<T> { readonly value: T; set(change: Partial<T>): void; forget(): void }

export function remembered<T extends object>(name: string, usual: T): Remembered<T> {
  let value = { ...usual };
  try { const kept = JSON.parse(localStorage.getItem(name) ?? "{}"); for (const key of Object.keys(usual) as (keyof T)[]) if (typeof kept[key] === typeof usual[key] && Array.isArray(kept[key]) === Array.isArray(usual[key])) value[key] = kept[key]; } catch { /* private windows keep nothing */ }
  const keep = () => { try { localStorage.setItem(name, JSON.stringify(value)); } catch { /* the same */ } };
  return { get value() { return value; }, set(change) { value = { ...value, ...change }; keep(); }, forget() { value = { ...usual }; keep(); } };
}
