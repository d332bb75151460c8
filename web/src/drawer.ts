// What the drawer says: how to repeat a result, what was assumed, and the numbers of a comparison.
import { element } from "./dom";

const section = (title: string, ...content: Node[]) => element("section", {}, element("h2", {}, title), ...content);
const list = (title: string, rows: string[]) => section(title, element("ul", {}, ...rows.map((row) => element("li", {}, row))));
function code(title: string, text: string): HTMLElement {
  return section(title, element("pre", { tabindex: 0 }, text), element("button", { "aria-label": `Copy: ${title}`, click: () => navigator.clipboard?.writeText(text) }, "Copy"));
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
