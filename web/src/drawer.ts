// What the drawer says: how to repeat a result, what was assumed, and the numbers of a comparison.
import { element } from "./dom";
import { SHORTCUTS, WORDS } from "./strings";

const section = (title: string, ...content: Node[]) => element("section", {}, element("h2", {}, title), ...content);
const list = (title: string, rows: string[]) => section(title, element("ul", {}, ...rows.map((row) => element("li", {}, row))));
function code(title: string, text: string): HTMLElement {
  const button = element("button", { "aria-label": `${WORDS.copy}: ${title}`, click: async () => { button.textContent = (await copied(text)) ? WORDS.copied : "Select the text and copy it"; setTimeout(() => (button.textContent = WORDS.copy), 2500); } }, WORDS.copy);
  return section(title, element("pre", { tabindex: 0 }, text), button);
}
/** Copies a text, also where the page is not served by HTTPS. */
async function copied(text: string): Promise<boolean> {
  try { await navigator.clipboard.writeText(text); return true; } catch { /* not offered to plain HTTP */ }
  const box = element("textarea", { class: "hidden" });
  (document.querySelector("dialog[open]") ?? document.body).append(box); // what lies outside an open dialog cannot be selected
  box.value = text; box.select();
  const done = document.execCommand("copy");
  box.remove();
  return done;
}

export function shortcuts(): Node[] {
  return [section(WORDS.shortcuts, element("table", {}, element("tbody", {}, ...SHORTCUTS.map(([keys, what]) => element("tr", {}, element("td", {}, element("kbd", {}, keys)), element("td", {}, what))))))];
}

/** The details of a result. */
export function details(header: any): Node[] {
  return [
    ...(header.command ? [code("Command line", header.command), code("Python", header.python)] : []),
    list("Assumed", header.meta.assumed ?? []),
    list("Time", Object.entries(header.seconds ?? {}).map(([name, seconds]) => `${name}: ${Number(seconds).toFixed(3)} s`)),
    code("meta.json", JSON.stringify(header.meta, null, 2)),
  ];
}

export interface Compared { text: string; rows: { title: string; effect: number; a: string; b: string; gives_away: boolean }[] }

/** The numbers of `mmweaver compare`: features by how clearly they tell B from A, marked where they give B away. */
export function numbers({ text, rows }: Compared): Node[] {
  const head = element("tr", {}, ...["", "feature", "effect size", "A", "B"].map((one) => element("th", { scope: "col" }, one)));
  const body = rows.map((row) => element("tr", row.gives_away ? { class: "gives-away" } : {},
    element("td", {}, row.gives_away ? "gives B away" : ""), element("th", { scope: "row" }, row.title), element("td", {}, row.effect.toFixed(1)), element("td", {}, row.a), element("td", {}, row.b)));
  return [section("A compared with B", element("table", {}, element("thead", {}, head), element("tbody", {}, ...body))), code("As mmweaver compare prints it", text)];
}
