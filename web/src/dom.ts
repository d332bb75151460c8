// Elements without a framework.

type Attributes = Record<string, string | number | boolean | ((event: any) => void)>;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (typeof value === "boolean") made.toggleAttribute(name, value);
    else made.setAttribute(name, String(value));
  }
  made.append(...children);
  return made;
}

/** The value of a CSS variable of the theme. */
export function themeColour(at: Element, name: string): string {
  return getComputedStyle(at).getPropertyValue(name).trim();
}

export const clamp = (value: number, low: number, high: number) => Math.max(low, Math.min(high, value));

export function download(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
