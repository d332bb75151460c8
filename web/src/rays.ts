// Propagation paths of a frame as the server traces them: vertices, kind, and where each lies in the radar's cells.
import type { Cursor } from "./chart";
import { element } from "./dom";
import { KINDS } from "./strings";
import type { Packed } from "./wire";

export interface Rays { points: number[][][]; kind: number[]; level: number[]; length: number[]; range: number[]; velocity: number[]; azimuth: number[] }
export interface CellSize { range: number; velocity: number; azimuth: number }

export function raysOf({ arrays }: Packed): Rays {
  const { ray_points: points, ray_facts: facts } = arrays, [count, most] = points.shape, column = (c: number) => Array.from({ length: count }, (_, i) => facts.data[6 * i + c]);
  const corners = (i: number) => Array.from({ length: most }, (_, k) => [...points.data.subarray(3 * (i * most + k), 3 * (i * most + k) + 3)]).filter((place) => Number.isFinite(place[0]));
  return { points: Array.from({ length: count }, (_, i) => corners(i)), kind: column(0), level: column(1), length: column(2), range: column(2).map((m) => m / 2), velocity: column(3), azimuth: column(4) };
}

/** The paths whose echo lies in a cell, the strongest first. */
export function inCell(rays: Rays, cell: Cursor, size: CellSize): number[] {
  const near = (value: number, at: number | undefined, width: number) => at === undefined || Math.abs(value - at) <= width;
  return [...rays.level.keys()].filter((i) => near(rays.range[i], cell.range, size.range) && near(rays.velocity[i], cell.velocity, size.velocity) && near(rays.azimuth[i], cell.azimuth, size.azimuth)).sort((a, b) => rays.level[b] - rays.level[a]);
}

const OF_ROOM = new Set([0, 1, 2, 8, 9]), MOST = 160, MOST_OF_ROOM = 50;
/** What is drawn without a cell: the strongest, mostly those over people. */
export function strongest({ kind }: Rays): number[] {
  let room = 0;
  return [...kind.keys()].filter((i) => !OF_ROOM.has(kind[i]) || room++ < MOST_OF_ROOM).slice(0, MOST);
}

const minus = (text: string) => text.replace("-", "−");
/** Kinds that are there with their colours, and the chosen paths with length and level. */
export function legend(rays: Rays, chosen: number[] | null): Node[] {
  const kinds = [...new Set(strongest(rays).map((i) => rays.kind[i]))].sort((a, b) => a - b);
  const swatch = (kind: number) => element("span", { class: "swatch", style: `background:${KINDS[kind][1]}` });
  const rows = chosen?.slice(0, 7).map((i) => element("li", {}, swatch(rays.kind[i]), `${KINDS[rays.kind[i]][0]}: ${rays.length[i].toFixed(2)} m, ${minus(rays.level[i].toFixed(0))} dBm, ${minus(rays.velocity[i].toFixed(2))} m/s`));
  return [
    element("p", {}, chosen ? `${chosen.length} path${chosen.length === 1 ? "" : "s"} in this cell` : `the strongest of ${rays.kind.length} paths; click a cell of a map for its own`),
    rows?.length ? element("ul", {}, ...rows) : element("div", { class: "kinds" }, ...kinds.map((kind) => element("span", {}, swatch(kind), KINDS[kind][0]))),
  ];
}
