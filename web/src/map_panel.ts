// One power map with axes, units, a cursor read-out and markers.
import { colourTable } from "./colours";
import { clamp, element, themeColour } from "./dom";
import type { Tensor } from "./wire";

const POWER = colourTable("inferno"), DIFFERENCE = colourTable("coolwarm");
const MARGIN = { left: 46, top: 24, right: 10, bottom: 36 };

export interface Axis { label: string; from: number; to: number; digits?: number }
export interface Picture { tensor: Tensor; at: number; rows: "last" | "first" }
export interface Pointer { x: number; y: number; column: number; row: number }
/** A rectangle or a line in data coordinates, drawn over the map. */
export interface Mark { x?: [number, number]; y?: [number, number]; colour?: string }

function ticks(from: number, to: number, about: number): number[] {
  const raw = Math.abs(to - from) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= 0.8 * raw)!;
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
  private cells: { data: ArrayLike<number>; columns: number; rows: number; index: (row: number, column: number) => number } | null = null;

  constructor(readonly title: string, public x: Axis, public y: Axis) {
    this.root = element("figure", { class: "panel" }, this.canvas, this.readout);
    this.canvas.addEventListener("pointermove", (event) => { this.hover(event); if (event.buttons && this.cursor) this.onPick(this.cursor, event); });
    this.canvas.addEventListener("pointerdown", (event) => { this.hover(event); if (this.cursor) this.onPick(this.cursor, event); });
    this.canvas.addEventListener("pointerleave", () => { this.setCursor(null); this.onHover(null); });
  }

  setCursor(cursor: Pointer | null): void { this.cursor = cursor; if (!cursor) this.readout.textContent = ""; }

  private box() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    return { left: MARGIN.left, top: MARGIN.top, width: Math.max(width - MARGIN.left - MARGIN.right, 1), height: Math.max(height - MARGIN.top - MARGIN.bottom, 1) };
  }

  private hover(event: PointerEvent): void {
    const box = this.box(), u = (event.offsetX - box.left) / box.width, v = 1 - (event.offsetY - box.top) / box.height;
    if (u < 0 || u > 1 || v < 0 || v > 1 || !this.cells) { this.setCursor(null); this.onHover(null); return; }
    const { columns, rows } = this.cells;
    this.cursor = {
      x: this.x.from + u * (this.x.to - this.x.from), y: this.y.from + v * (this.y.to - this.y.from),
      column: clamp(Math.floor(u * columns), 0, columns - 1), row: clamp(Math.floor(v * rows), 0, rows - 1),
    };
    this.onHover(this.cursor);
  }

  /** Draws bytes as decibels between `low` and `high` of the scale; `columns` of time are stored first. */
  draw(picture: Picture, scale: { low: number; high: number; unit: string }, window: [number, number]): void {
    const { tensor, at, rows: order } = picture, [a, b] = tensor.shape.slice(-2);
    const offset = tensor.shape.length === 3 ? at * a * b : 0;
    const rows = order === "first" ? a : b, columns = order === "first" ? b : a;
    const index = order === "first" ? (r: number, c: number) => offset + r * columns + c : (r: number, c: number) => offset + c * rows + r;
    this.cells = { data: tensor.data, columns, rows, index };
    const span = scale.high - scale.low, gain = span / (window[1] - window[0]), shift = ((scale.low - window[0]) / (window[1] - window[0])) * 255;
    this.paint(rows, columns, (r, c) => POWER.subarray((clamp(Math.round(tensor.data[index(r, c)] * gain + shift), 0, 255)) * 4));
    this.frame();
    if (this.cursor) {
      const value = scale.low + (tensor.data[index(Math.min(this.cursor.row, rows - 1), Math.min(this.cursor.column, columns - 1))] / 255) * span;
      this.readout.textContent = `${this.cursor.x.toFixed(2)} ${unitOf(this.x.label)}, ${this.cursor.y.toFixed(2)} ${unitOf(this.y.label)}: ${value.toFixed(0)} ${scale.unit}`;
    }
  }

  /** Draws B less A in decibels, blue to red over -20 to 20 dB. */
  drawDifference(a: Picture, b: Picture, scaleA: { low: number; high: number }, scaleB: { low: number; high: number }): void {
    const [rows, columns] = a.tensor.shape.slice(-2), offsetA = a.at * rows * columns, offsetB = b.at * rows * columns;
    const toDb = (value: number, s: { low: number; high: number }) => s.low + (value / 255) * (s.high - s.low);
    this.cells = null;
    this.paint(rows, columns, (r, c) => {
      const i = r * columns + c, d = toDb(b.tensor.data[offsetB + i], scaleB) - toDb(a.tensor.data[offsetA + i], scaleA);
      return DIFFERENCE.subarray(clamp(Math.round((d / 40 + 0.5) * 255), 0, 255) * 4);
    });
    this.frame();
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
    g.drawImage(this.raster, box.left, box.top, box.width, box.height);
    g.font = '600 12px system-ui, "DejaVu Sans", sans-serif'; g.fillStyle = ink;
    g.fillText(fitted(g, this.title, width - 12 - Math.min(box.left, 14)), Math.min(box.left, 14), 15);
    g.font = '11px system-ui, "DejaVu Sans", sans-serif'; g.fillStyle = faint; g.strokeStyle = faint;
    const px = (x: number) => box.left + ((x - this.x.from) / (this.x.to - this.x.from)) * box.width;
    const py = (y: number) => box.top + (1 - (y - this.y.from) / (this.y.to - this.y.from)) * box.height;
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

/** The text, cut with an ellipsis where it is wider than so many pixels. */
function fitted(g: CanvasRenderingContext2D, text: string, width: number): string {
  if (g.measureText(text).width <= width) return text;
  let end = text.length;
  while (end > 1 && g.measureText(`${text.slice(0, end)}…`).width > width) end--;
  return `${text.slice(0, end)}…`;
}
const unitOf = (label: string) => label.match(/\(([^,)]+)/)?.[1] ?? "";
const tidy = (value: number) => String(Math.round(value * 1000) / 1000);
