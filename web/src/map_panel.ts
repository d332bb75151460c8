// One power map with axes, units, a cursor read-out and markers.
import { colourTable } from "./colours";
import { clamp, element, themeColour } from "./dom";
import type { Tensor } from "./wire";

const POWER = colourTable("inferno"), DIFFERENCE = colourTable("coolwarm");
const NOTHING = [128, 128, 128];
const MARGIN = { left: 46, top: 24, right: 10, bottom: 36 };

export interface Axis { label: string; from: number; to: number; digits?: number }
/** Bytes of decibels from `low` to `high`; `across` and `up` are what its columns and rows span, in units of the axes. */
export interface Picture { tensor: Tensor; at: number; rows: "last" | "first"; low: number; high: number; across: [number, number]; up: [number, number] }
export interface Pointer { x: number; y: number }
/** A rectangle or a line in data coordinates, drawn over the map. */
export interface Mark { x?: [number, number]; y?: [number, number]; colour?: string }

function ticks(from: number, to: number, about: number): number[] {
  const raw = Math.abs(to - from) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= 0.65 * raw)!;
  const out: number[] = [];
  for (let v = Math.ceil(Math.min(from, to) / step) * step; v <= Math.max(from, to) + 1e-9; v += step) out.push(Math.abs(v) < 1e-12 ? 0 : v);
  return out;
}

export class MapPanel {
  readonly root: HTMLElement;
  readonly canvas = element("canvas", { role: "img", tabindex: 0 });
  onHover: (pointer: Pointer | null) => void = () => {};
  onPick: (pointer: Pointer, event: PointerEvent) => void = () => {};
  cursor: Pointer | null = null;
  marks: Mark[] = [];
  private readout = element("output", { class: "readout" });
  private raster = document.createElement("canvas");
  private cells: { picture: Picture; columns: number; rows: number; text: (row: number, column: number) => string } | null = null;

  constructor(readonly title: string, public x: Axis, public y: Axis) {
    this.root = element("figure", { class: "panel" }, this.canvas, this.readout);
    this.canvas.addEventListener("pointermove", (event) => { this.hover(event); if (event.buttons && this.cursor) this.onPick(this.cursor, event); });
    this.canvas.addEventListener("pointerdown", (event) => { this.hover(event); if (this.cursor) this.onPick(this.cursor, event); });
    for (const leaves of ["pointerleave", "blur"]) this.canvas.addEventListener(leaves, () => { this.setCursor(null); this.onHover(null); });
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  setCursor(cursor: Pointer | null): void { this.cursor = cursor; if (!cursor) this.readout.textContent = ""; }

  private box() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    return { left: MARGIN.left, top: MARGIN.top, width: Math.max(width - MARGIN.left - MARGIN.right, 1), height: Math.max(height - MARGIN.top - MARGIN.bottom, 1) };
  }

  private hover(event: PointerEvent): void {
    const box = this.box(), u = (event.offsetX - box.left) / box.width, v = 1 - (event.offsetY - box.top) / box.height;
    if (u < 0 || u > 1 || v < 0 || v > 1) { this.setCursor(null); this.onHover(null); return; }
    this.pointAt(this.x.from + u * (this.x.to - this.x.from), this.y.from + v * (this.y.to - this.y.from));
  }
  /** Shift and an arrow key move the cursor by a cell. */
  private key(event: KeyboardEvent): void {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!by || !event.shiftKey || !this.cells) return;
    event.preventDefault(); event.stopPropagation();
    const { picture: { across, up }, columns, rows } = this.cells, wide = (across[1] - across[0]) / columns, high = (up[1] - up[0]) / rows;
    const { x, y } = this.cursor ?? { x: (this.x.from + this.x.to) / 2, y: (this.y.from + this.y.to) / 2 };
    this.pointAt(clamp(x + by[0] * wide, this.x.from, this.x.to), clamp(y + by[1] * high, this.y.from, this.y.to));
  }
  private pointAt(x: number, y: number): void {
    if (!this.cells) return;
    this.cursor = { x, y };
    this.onHover(this.cursor);
  }

  /** Draws a picture; `window` are the decibels of the darkest and the brightest colour. */
  draw(picture: Picture, unit: string, window: [number, number]): void {
    const { rows, columns, index } = grid(picture), { data } = picture.tensor, span = picture.high - picture.low;
    const gain = span / (window[1] - window[0]), shift = ((picture.low - window[0]) / (window[1] - window[0])) * 255;
    this.cells = { picture, columns, rows, text: (r, c) => `${(picture.low + (data[index(r, c)] / 255) * span).toFixed(0)} ${unit}` };
    this.paint(rows, columns, (r, c) => POWER.subarray(clamp(Math.round(data[index(r, c)] * gain + shift), 0, 255) * 4));
    this.frame();
    this.readOut();
  }

  /** Draws B less A in decibels, blue to red over -20 to 20 dB, on the cells of A; grey where B shows nothing. */
  drawDifference(a: Picture, b: Picture): void {
    const own = grid(a), other = grid(b), dB = (picture: Picture, i: number) => picture.low + (picture.tensor.data[i] / 255) * (picture.high - picture.low);
    const difference = (r: number, c: number): number | null => {
      const x = a.across[0] + ((c + 0.5) / own.columns) * (a.across[1] - a.across[0]), y = a.up[0] + ((r + 0.5) / own.rows) * (a.up[1] - a.up[0]);
      const column = cell(x, b.across, other.columns), row = cell(y, b.up, other.rows);
      return column < 0 || row < 0 ? null : dB(b, other.index(row, column)) - dB(a, own.index(r, c));
    };
    this.cells = { picture: a, columns: own.columns, rows: own.rows, text: (r, c) => { const d = difference(r, c); return d === null ? "not shown by B" : `${d.toFixed(0)} dB`; } };
    this.paint(own.rows, own.columns, (r, c) => { const d = difference(r, c); return d === null ? NOTHING : DIFFERENCE.subarray(clamp(Math.round((d / 40 + 0.5) * 255), 0, 255) * 4); });
    this.frame();
    this.readOut();
  }

  private readOut(): void {
    const { cursor, cells } = this;
    if (!cursor || !cells) return;
    const { picture: { across, up } } = cells, column = cell(cursor.x, across, cells.columns), row = cell(cursor.y, up, cells.rows);
    const value = column < 0 || row < 0 ? "nothing" : cells.text(row, column);
    this.readout.textContent = `${cursor.x.toFixed(2)} ${unitOf(this.x.label)}, ${cursor.y.toFixed(2)} ${unitOf(this.y.label)}: ${value}`;
  }

  private paint(rows: number, columns: number, colour: (row: number, column: number) => ArrayLike<number>): void {
    this.raster.width = columns; this.raster.height = rows;
    const context = this.raster.getContext("2d")!, image = context.createImageData(columns, rows);
    for (let r = 0; r < rows; r++)
      for (let c = 0; c < columns; c++) {
        const rgb = colour(r, c), o = ((rows - 1 - r) * columns + c) * 4;
        image.data[o] = rgb[0]; image.data[o + 1] = rgb[1]; image.data[o + 2] = rgb[2]; image.data[o + 3] = 255;
      }
    context.putImageData(image, 0, 0);
  }

  private frame(): void {
    const ratio = devicePixelRatio || 1, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width || !height) return;
    this.canvas.width = width * ratio; this.canvas.height = height * ratio;
    const g = this.canvas.getContext("2d")!, box = this.box();
    const ink = themeColour(this.canvas, "--ink") || "#222", faint = themeColour(this.canvas, "--faint") || "#555";
    g.scale(ratio, ratio);
    g.imageSmoothingEnabled = false;
    g.font = '600 12px system-ui, "DejaVu Sans", sans-serif'; g.fillStyle = ink;
    g.fillText(fitted(g, this.title, width - 12 - Math.min(box.left, 14)), Math.min(box.left, 14), 15);
    g.font = '11px system-ui, "DejaVu Sans", sans-serif'; g.fillStyle = faint; g.strokeStyle = faint;
    const px = (x: number) => box.left + ((x - this.x.from) / (this.x.to - this.x.from)) * box.width;
    const py = (y: number) => box.top + (1 - (y - this.y.from) / (this.y.to - this.y.from)) * box.height;
    if (this.cells) {
      const { across, up } = this.cells.picture;
      g.save(); g.beginPath(); g.rect(box.left, box.top, box.width, box.height); g.clip();
      g.drawImage(this.raster, px(across[0]), py(up[1]), px(across[1]) - px(across[0]), py(up[0]) - py(up[1]));
      g.restore();
    }
    g.textAlign = "center";
    for (const t of ticks(this.x.from, this.x.to, Math.max(2, box.width / 55))) { g.fillRect(px(t), box.top + box.height, 1, 3); g.fillText(tidy(t), px(t), box.top + box.height + 14); }
    g.textAlign = "right";
    for (const t of ticks(this.y.from, this.y.to, Math.max(2, box.height / 30))) { g.fillRect(box.left - 3, py(t), 3, 1); g.fillText(tidy(t), box.left - 5, py(t) + 4); }
    g.textAlign = "center";
    g.fillText(this.x.label, box.left + box.width / 2, box.top + box.height + 29);
    g.save(); g.translate(11, box.top + box.height / 2); g.rotate(-Math.PI / 2); g.fillText(this.y.label, 0, 0); g.restore();
    g.textAlign = "left";
    g.save(); g.beginPath(); g.rect(box.left, box.top, box.width, box.height); g.clip();
    for (const mark of this.marks) {
      g.strokeStyle = mark.colour ?? "#7fe3ff"; g.lineWidth = 1.5;
      const x0 = mark.x ? px(mark.x[0]) : box.left - 5, x1 = mark.x ? px(mark.x[1]) : box.left + box.width + 5;
      const y0 = mark.y ? py(mark.y[0]) : box.top - 5, y1 = mark.y ? py(mark.y[1]) : box.top + box.height + 5;
      g.strokeRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
    }
    if (this.cursor) {
      g.strokeStyle = "#ffffff"; g.lineWidth = 1; g.beginPath();
      g.moveTo(px(this.cursor.x), box.top); g.lineTo(px(this.cursor.x), box.top + box.height);
      g.moveTo(box.left, py(this.cursor.y)); g.lineTo(box.left + box.width, py(this.cursor.y)); g.stroke();
    }
    g.restore();
  }
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

/** The text, cut with an ellipsis where it is wider than so many pixels. */
function fitted(g: CanvasRenderingContext2D, text: string, width: number): string {
  if (g.measureText(text).width <= width) return text;
  let end = text.length;
  while (end > 1 && g.measureText(`${text.slice(0, end)}…`).width > width) end--;
  return `${text.slice(0, end)}…`;
}
const unitOf = (label: string) => label.match(/\(([^,)]+)/)?.[1] ?? "";
const tidy = (value: number) => String(Math.round(value * 1000) / 1000);
