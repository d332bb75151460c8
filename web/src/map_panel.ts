// A map of power: cells of bytes to colours by a table, as rows and columns or laid out as a fan of range and azimuth.
import { Chart, type Cursor } from "./chart";
import { colourTable } from "./colours";
import { clamp } from "./dom";
import type { Tensor } from "./wire";

const POWER = words(colourTable("inferno")), DIFFERENCE = words(colourTable("coolwarm"));
const NOTHING = 0xff808080;
const FAN_ROWS = 220;
export const DIFFERENCE_DB = 20;

function words(bytes: Uint8ClampedArray): Uint32Array { return new Uint32Array(bytes.buffer); }

/** Bytes of decibels from `low` to `high`; `across` and `up` are what columns and rows span, in units of the axes (a fan: radians and metres). */
export interface Picture { tensor: Tensor; at: number; rows: "last" | "first"; low: number; high: number; across: [number, number]; up: [number, number]; version: number }

export class MapPanel extends Chart {
  private raster = document.createElement("canvas");
  private image: ImageData | null = null;
  private places: { key: string; index: Int32Array; width: number; height: number } | null = null;
  private shown: { key: unknown[]; picture: Picture; value: (row: number, column: number) => number | null; unit: string } | null = null;
  private isDifference = false;
  private lut = new Uint32Array(256);

  /** Shows a picture; `window` are the decibels of the darkest and the brightest colour. Painted only where something changed. */
  show(picture: Picture, unit: string, window: [number, number]): void {
    const key = [picture.tensor.data, picture.at, picture.version, picture.low, picture.high, ...window, picture.across[1]];
    if (this.isAs(key)) { this.draw(); return; }
    const { index } = grid(picture), { data } = picture.tensor, span = picture.high - picture.low;
    for (let v = 0; v < 256; v++) this.lut[v] = POWER[clamp(Math.round(((picture.low + (v / 255) * span - window[0]) / (window[1] - window[0])) * 255), 0, 255)];
    this.shown = { key, picture, unit, value: (r, c) => picture.low + (data[index(r, c)] / 255) * span };
    const pixels = this.pixels(picture), { index: places } = this.places!, offset = picture.tensor.shape.length === 3 ? picture.at * picture.tensor.shape[1] * picture.tensor.shape[2] : 0;
    for (let i = 0; i < places.length; i++) pixels[i] = places[i] < 0 ? 0 : this.lut[data[offset + places[i]]];
    this.finish();
  }

  /** Shows B − A in decibels on the cells of A; grey where B shows nothing. */
  showDifference(a: Picture, b: Picture, window: [number, number]): void {
    const key = [a.tensor.data, a.at, b.tensor.data, b.at, a.low, b.low, window[0]];
    if (this.isAs(key)) { this.draw(); return; }
    const own = grid(a), other = grid(b), dB = (picture: Picture, i: number) => Math.max(window[0], picture.low + (picture.tensor.data[i] / 255) * (picture.high - picture.low));
    const columns = Int32Array.from({ length: own.columns }, (_, c) => cell(a.across[0] + ((c + 0.5) / own.columns) * (a.across[1] - a.across[0]), b.across, other.columns));
    const rows = Int32Array.from({ length: own.rows }, (_, r) => cell(a.up[0] + ((r + 0.5) / own.rows) * (a.up[1] - a.up[0]), b.up, other.rows));
    const value = (r: number, c: number) => (columns[c] < 0 || rows[r] < 0 ? null : dB(b, other.index(rows[r], columns[c])) - dB(a, own.index(r, c)));
    this.shown = { key, picture: a, unit: "dB", value }; this.isDifference = true;
    const pixels = this.pixels(a), { index: places } = this.places!, first = a.rows === "first";
    for (let i = 0; i < places.length; i++) {
      if (places[i] < 0) { pixels[i] = 0; continue; }
      const d = first ? value(Math.floor(places[i] / own.columns), places[i] % own.columns) : value(places[i] % own.rows, Math.floor(places[i] / own.rows));
      pixels[i] = d === null ? NOTHING : DIFFERENCE[clamp(Math.round((d / (2 * DIFFERENCE_DB) + 0.5) * 255), 0, 255)];
    }
    this.finish();
  }

  /** The value under a cursor, in decibels; null outside. */
  valueAt(cursor: Cursor): number | null {
    const at = this.isFan ? { x: cursor.azimuth, y: cursor.range } : this.place(cursor);
    if (!this.shown || at.x === undefined || at.y === undefined) return null;
    const { picture, value } = this.shown, { rows, columns } = grid(picture), column = cell(at.x, picture.across, columns), row = cell(at.y, picture.up, rows);
    return column < 0 || row < 0 ? null : value(row, column);
  }
  protected valueText(cursor: Cursor): string { const value = this.valueAt(cursor), isOn = this.isFan ? cursor.azimuth !== undefined : this.place(cursor).x !== undefined && this.place(cursor).y !== undefined; return value === null ? (isOn && this.isDifference ? "not shown by B" : "") : `${value.toFixed(0)} ${this.shown!.unit}`.replace("-", "−"); }
  protected step(): [number, number] {
    if (!this.shown) return [0.1, 0.1];
    const { picture: { across, up }, picture } = this.shown, { rows, columns } = grid(picture), high = (up[1] - up[0]) / rows;
    return this.isFan ? [high, high] : [(across[1] - across[0]) / columns, high];
  }
  protected paint(g: CanvasRenderingContext2D, px: (x: number) => number, py: (y: number) => number): void {
    if (!this.shown) return;
    const { across, up } = this.shown.picture;
    if (this.isFan) { const far = up[1], wide = far * Math.sin(Math.min(across[1], Math.PI / 2)); g.drawImage(this.raster, px(-wide), py(far), px(wide) - px(-wide), py(0) - py(far)); return; }
    g.drawImage(this.raster, px(across[0]), py(up[1]), px(across[1]) - px(across[0]), py(up[0]) - py(up[1]));
  }

  private isAs(key: unknown[]): boolean { return this.shown !== null && key.length === this.shown.key.length && key.every((part, k) => part === this.shown!.key[k]); }
  private pixels(picture: Picture): Uint32Array {
    const { rows, columns } = grid(picture), key = `${rows} ${columns} ${picture.rows} ${this.isFan ? [picture.across, picture.up] : ""}`;
    if (this.places?.key !== key) {
      const made = this.isFan ? fanPlaces(picture, rows, columns) : flatPlaces(picture, rows, columns);
      this.places = { key, ...made };
      this.raster.width = made.width; this.raster.height = made.height;
      this.image = this.raster.getContext("2d")!.createImageData(made.width, made.height);
    }
    return new Uint32Array(this.image!.data.buffer);
  }
  private finish(): void { this.raster.getContext("2d")!.putImageData(this.image!, 0, 0); this.isStale = true; this.draw(); if (this.cursor) this.point(this.cursor); }
}

function flatPlaces(picture: Picture, rows: number, columns: number) {
  const index = new Int32Array(rows * columns);
  for (let r = 0; r < rows; r++) for (let c = 0; c < columns; c++) index[(rows - 1 - r) * columns + c] = picture.rows === "first" ? r * columns + c : c * rows + r;
  return { index, width: columns, height: rows };
}
/** Cells of a raster that looks from above; -1 outside the fan. */
function fanPlaces({ across, up }: Picture, rows: number, columns: number) {
  const far = up[1], wide = far * Math.sin(Math.min(across[1], Math.PI / 2)), height = FAN_ROWS, width = Math.max(2, Math.round((2 * wide * height) / far)), index = new Int32Array(width * height);
  for (let v = 0; v < height; v++)
    for (let u = 0; u < width; u++) {
      const y = far * (1 - (v + 0.5) / height), x = wide * ((2 * (u + 0.5)) / width - 1), r = cell(Math.hypot(x, y), up, rows), c = cell(Math.atan2(x, y), across, columns);
      index[v * width + u] = r < 0 || c < 0 ? -1 : r * columns + c;
    }
  return { index, width, height };
}
/** Rows, columns and the place of a cell in the data. */
function grid({ tensor, at, rows: order }: Picture): { rows: number; columns: number; index: (row: number, column: number) => number } {
  const [a, b] = tensor.shape.slice(-2), offset = tensor.shape.length === 3 ? at * a * b : 0;
  if (order === "first") return { rows: a, columns: b, index: (r, c) => offset + r * b + c };
  return { rows: b, columns: a, index: (r, c) => offset + c * b + r };
}
/** The cell of a value; -1 outside the span. */
function cell(value: number, [from, to]: [number, number], count: number): number {
  const index = Math.floor(((value - from) / (to - from)) * count);
  return index >= 0 && index < count ? index : value === to ? count - 1 : -1;
}
