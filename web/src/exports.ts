// What can be taken away: files that the server writes, and pictures of what is on the page.
import { download, element } from "./dom";
import type { Player } from "./player";

const PICTURES: [string, string][] = [["page-png", "picture of the panels (png)"], ["page-svg", "picture of the panels (svg)"]];

export function exportChoices(offered: [string, string][]): HTMLElement[] {
  return [element("option", { value: "" }, "Export…"), ...[...offered, ...PICTURES].map(([value, label]) => element("option", { value }, label))];
}

export async function saveOf(kind: string, player: Player, file: (kind: string) => Promise<{ name: string; content: Blob }>): Promise<void> {
  if (!kind.startsWith("page-")) { const { name, content } = await file(kind); download(name, content); return; }
  const canvas = panelsOn(player);
  if (kind === "page-png") { download("mmweaver.png", await new Promise<Blob>((resolve) => canvas.toBlob((made) => resolve(made!), "image/png"))); return; }
  download("mmweaver.svg", new Blob([svgOf(player)], { type: "image/svg+xml" }));
}

/** All panels as they lie on the page, drawn at twice their size. */
function panelsOn(player: Player): HTMLCanvasElement {
  const box = player.root.getBoundingClientRect(), canvas = element("canvas", { width: Math.round(2 * box.width), height: Math.round(2 * box.height) }), g = canvas.getContext("2d")!;
  g.scale(2, 2);
  g.fillStyle = getComputedStyle(player.root.closest(".mmweaver")!).getPropertyValue("--panel"); g.fillRect(0, 0, box.width, box.height);
  const scene = player.scene.element.getBoundingClientRect();
  g.drawImage(player.scene.element, scene.left - box.left, scene.top - box.top, scene.width, scene.height);
  for (const { canvas: panel, chart } of player.drawnPanels()) {
    const at = panel.getBoundingClientRect();
    g.save(); g.translate(at.left - box.left, at.top - box.top); chart.drawOn(g); g.restore();
  }
  return canvas;
}

/** The same as SVG: each panel a picture, its title as text that can be searched. */
function svgOf(player: Player): string {
  const box = player.root.getBoundingClientRect(), parts: string[] = [], escape = (text: string) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
  const image = (url: string, at: DOMRect, title: string) => parts.push(`<image x="${at.left - box.left}" y="${at.top - box.top}" width="${at.width}" height="${at.height}" href="${url}"><title>${escape(title)}</title></image>`);
  image(player.scene.element.toDataURL("image/png"), player.scene.element.getBoundingClientRect(), "Room");
  for (const { canvas: panel, chart } of player.drawnPanels()) {
    const at = panel.getBoundingClientRect(), own = element("canvas", { width: Math.round(2 * at.width), height: Math.round(2 * at.height) }), g = own.getContext("2d")!;
    g.scale(2, 2); chart.drawOn(g); image(own.toDataURL("image/png"), at, chart.title);
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${box.width} ${box.height}">${parts.join("")}</svg>`;
}
