// Axes, ticks, zoom and the shared cursor of every panel. What lies under the axes is painted once; cursor and marks lie on a canvas of their own.
import { clamp, element, themeColour } from "./dom";

const MARGIN = { left: 50, top: 22, right: 8, bottom: 32 }; // at the usual size of letters, 14 px
const FONT = 'system-ui, "DejaVu Sans", sans-serif';

/** A place in what all panels show: range in metres, radial velocity in m/s, azimuth in radians, time in seconds, as far as known. */
export interface Cursor { range?: number; velocity?: number; azimuth?: number; time?: number }
export type Quantity = keyof Cursor;
/** `quantity` times `factor` is what the axis counts; axes of metres to the side and ahead have none. */
export interface Axis { label: string; from: number; to: number; quantity?: Quantity; factor?: number }
/** A rectangle or a band in the units of the axes; in a fan of range (up) and azimuth in radians (across). */
export interface Mark { x?: [number, number]; y?: [number, number]; colour?: string; dashed?: boolean }

export function ticks(from: number, to: number, about: number): number[] {
  const raw = Math.abs(to - from) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= 0.65 * raw)!, out: number[] = [];
  for (let v = Math.ceil(Math.min(from, to) / step) * step; v <= Math.max(from, to) + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-12 ? 0 : v);
  return out;
}
const tidy = (value: number) => String(Math.round(value * 1000) / 1000).replace("-", "−");

export abstract class Chart {
  readonly root: HTMLElement;
  readonly canvas = element("canvas", { role: "img", tabindex: 0 });
  onHover: (cursor: Cursor | null) => void = () => {};
  onPick: (cursor: Cursor, isDrag: boolean) => void = () => {};
  cursor: Cursor | null = null;
  marks: Mark[] = [];
  isFan = false;
  private base = element("canvas", { "aria-hidden": "true" });
  private drawnOver = "";
  private readout = element("output", { class: "readout" });
  private whole: { x: [number, number]; y: [number, number] };
  protected isDirty = true; // all of it; what lies within the axes alone: isStale
  protected isStale = false;

  constructor(public title: string, public x: Axis, public y: Axis) {
    this.whole = { x: [x.from, x.to], y: [y.from, y.to] };
    this.root = element("figure", { class: "panel" }, this.base, this.canvas, this.readout);
    const point = (event: PointerEvent) => this.inside(event.offsetX, event.offsetY);
    this.canvas.addEventListener("pointermove", (event) => { const at = point(event); this.onHover(at && this.cursorAt(...at)); if (at && event.buttons) this.onPick(this.cursorAt(...at), true); });
    this.canvas.addEventListener("pointerdown", (event) => { const at = point(event); if (at) this.onPick(this.cursorAt(...at), false); });
    for (const leaves of ["pointerleave", "blur"]) this.canvas.addEventListener(leaves, () => this.onHover(null));
    this.canvas.addEventListener("wheel", (event) => { const at = point(event as any); if (at && (event.ctrlKey || event.altKey || document.activeElement === this.canvas)) { event.preventDefault(); this.zoom(event.deltaY > 0 ? 1.25 : 0.8, at); } }, { passive: false });
    this.canvas.addEventListener("dblclick", () => this.unzoom());
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => { this.isDirty = true; this.draw(); }).observe(this.canvas);
  }

  /** The cursor in words: the value under it, for the read-out. */
  protected abstract valueText(cursor: Cursor): string;
  /** Paints what the panel shows within the axes. */
  protected abstract paint(g: CanvasRenderingContext2D, px: (x: number) => number, py: (y: number) => number): void;
  /** How far the keys move the cursor. */
  protected abstract step(): [number, number];

  setAxes(x: Axis, y: Axis): void {
    if ([x.from, x.to, y.from, y.to].every((value, k) => value === [this.whole.x, this.whole.y].flat()[k])) return;
    this.x = x; this.y = y; this.whole = { x: [x.from, x.to], y: [y.from, y.to] }; this.isDirty = true;
  }
  /** Shows a cursor that another panel set; its own read-out where it holds both axes. */
  point(cursor: Cursor | null): void {
    this.cursor = cursor;
    this.readout.textContent = cursor ? this.valueText(cursor) : "";
    this.drawOver();
  }
  draw(): void {
    if (this.isDirty || this.isStale) this.drawBase();
    this.drawOver();
  }
  redraw(): void { this.isDirty = true; this.draw(); }

  /** In the units of the axes, from the quantities. */
  protected place(cursor: Cursor): { x?: number; y?: number } {
    if (this.isFan) return cursor.range !== undefined && cursor.azimuth !== undefined ? { x: cursor.range * Math.sin(cursor.azimuth), y: cursor.range * Math.cos(cursor.azimuth) } : {};
    const of = (axis: Axis) => (axis.quantity && cursor[axis.quantity] !== undefined ? cursor[axis.quantity]! * (axis.factor ?? 1) : undefined);
    return { x: of(this.x), y: of(this.y) };
  }
  protected cursorAt(x: number, y: number): Cursor {
    if (this.isFan) return { range: Math.hypot(x, y), azimuth: Math.atan2(x, y) };
    const cursor: Cursor = {};
    for (const [axis, value] of [[this.x, x], [this.y, y]] as const) if (axis.quantity) cursor[axis.quantity] = value / (axis.factor ?? 1);
    return cursor;
  }
  /** Size of letters, to the usual one. */
  protected scale = 1;
  protected box() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight, { left, top, right, bottom } = MARGIN, k = this.scale;
    const box = { left: k * left, top: k * top, width: Math.max(width - k * (left + right), 1), height: Math.max(height - k * (top + bottom), 1) };
    if (this.isFan) { // a metre is as long in both directions
      const scale = Math.min(box.width / (this.x.to - this.x.from), box.height / (this.y.to - this.y.from)), w = scale * (this.x.to - this.x.from), h = scale * (this.y.to - this.y.from);
      return { left: box.left + (box.width - w) / 2, top: box.top + (box.height - h) / 2, width: w, height: h };
    }
    return box;
  }
  private inside(offsetX: number, offsetY: number): [number, number] | null {
    const box = this.box(), u = (offsetX - box.left) / box.width, v = 1 - (offsetY - box.top) / box.height;
    return u < 0 || u > 1 || v < 0 || v > 1 ? null : [this.x.from + u * (this.x.to - this.x.from), this.y.from + v * (this.y.to - this.y.from)];
  }
  private key(event: KeyboardEvent): void {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const now = this.cursor ? this.place(this.cursor) : {}, at: [number, number] = [now.x ?? (this.x.from + this.x.to) / 2, now.y ?? (this.y.from + this.y.to) / 2];
    if (by && event.shiftKey) { const [wide, high] = this.step(); this.onHover(this.cursorAt(clamp(at[0] + by[0] * wide, this.x.from, this.x.to), clamp(at[1] + by[1] * high, this.y.from, this.y.to))); }
    else if (event.key === "Enter" && this.cursor) this.onPick(this.cursor, false);
    else if (event.key === "+" || event.key === "-") this.zoom(event.key === "+" ? 0.7 : 1 / 0.7, at);
    else return;
    event.preventDefault(); event.stopPropagation();
  }
  private zoom(by: number, [x, y]: [number, number]): void {
    const scaled = (axis: Axis, at: number, [low, high]: [number, number]) => {
      const from = at + (axis.from - at) * by, to = at + (axis.to - at) * by;
      return to - from >= high - low ? [low, high] : [Math.max(low, from), Math.min(high, to)];
    };
    [this.x.from, this.x.to] = scaled(this.x, x, this.whole.x); [this.y.from, this.y.to] = scaled(this.y, y, this.whole.y);
    this.redraw();
  }
  unzoom(): void { [this.x.from, this.x.to] = this.whole.x; [this.y.from, this.y.to] = this.whole.y; this.redraw(); }

  protected px = (x: number) => { const box = this.box(); return box.left + ((x - this.x.from) / (this.x.to - this.x.from)) * box.width; };
  protected py = (y: number) => { const box = this.box(); return box.top + (1 - (y - this.y.from) / (this.y.to - this.y.from)) * box.height; };

  private sized(canvas: HTMLCanvasElement): CanvasRenderingContext2D | null {
    const ratio = devicePixelRatio || 1, width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (!width || !height) return null;
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; this.isDirty = true; }
    const g = canvas.getContext("2d")!;
    g.setTransform(ratio, 0, 0, ratio, 0, 0); g.clearRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    return g;
  }
  private drawBase(): void {
    if (this.isStale && !this.isDirty) { this.isStale = false; this.drawContent(this.base.getContext("2d")!); return; }
    const g = this.sized(this.base);
    if (!g) return;
    this.isDirty = this.isStale = false;
    this.scale = parseFloat(getComputedStyle(this.root).fontSize) / 14 || 1;
    this.drawOn(g);
  }
  /** Axes and content, on the page or for a picture of it. */
  drawOn(g: CanvasRenderingContext2D): void {
    const box = this.box(), width = this.canvas.clientWidth, height = this.canvas.clientHeight, px = this.px, py = this.py, k = this.scale;
    const ink = themeColour(this.canvas, "--ink") || "#222", faint = themeColour(this.canvas, "--faint") || "#555";
    g.imageSmoothingEnabled = false;
    g.font = `600 ${12 * k}px ${FONT}`; g.fillStyle = ink; g.textAlign = "left";
    g.fillText(fitted(g, this.title, width - 24 * k), 12 * k, 15 * k);
    this.drawContent(g);
    g.font = `${11 * k}px ${FONT}`; g.fillStyle = faint; g.textAlign = "center";
    for (const t of ticks(this.x.from, this.x.to, Math.max(2, box.width / (55 * k)))) { g.fillRect(px(t), box.top + box.height, 1, 3); g.fillText(tidy(t), clamp(px(t), 12 * k, width - 12 * k), box.top + box.height + 13 * k); }
    g.textAlign = "right";
    for (const t of ticks(this.y.from, this.y.to, Math.max(2, box.height / (28 * k)))) { g.fillRect(box.left - 3, py(t), 3, 1); g.fillText(tidy(t), box.left - 5, py(t) + 4 * k); }
    g.textAlign = "center";
    g.fillText(this.x.label, box.left + box.width / 2, Math.min(box.top + box.height + 26 * k, height - 4 * k));
    g.save(); g.translate(Math.max(12 * k, box.left - 38 * k), box.top + box.height / 2); g.rotate(-Math.PI / 2); g.fillText(this.y.label, 0, 0); g.restore();
  }
  private drawContent(g: CanvasRenderingContext2D): void {
    const box = this.box();
    g.imageSmoothingEnabled = false;
    g.save(); g.beginPath(); g.rect(box.left, box.top, box.width, box.height); g.clip();
    g.fillStyle = themeColour(this.canvas, "--panel") || "#fff"; g.fillRect(box.left, box.top, box.width, box.height);
    this.paint(g, this.px, this.py);
    g.restore();
  }
  protected drawOver(): void {
    const key = JSON.stringify([this.marks, this.cursor, this.isDirty, this.canvas.clientWidth, this.canvas.clientHeight, this.x.from, this.x.to, this.y.from, this.y.to]);
    if (key === this.drawnOver) return;
    this.drawnOver = key;
    const g = this.sized(this.canvas);
    if (!g) return;
    if (this.isDirty) this.drawBase();
    const box = this.box();
    g.beginPath(); g.rect(box.left, box.top, box.width, box.height); g.clip();
    for (const mark of this.marks) { g.strokeStyle = mark.colour ?? "#7fe3ff"; g.lineWidth = 1.5; g.setLineDash(mark.dashed ? [4, 3] : []); this.trace(g, mark); }
    g.setLineDash([]);
    if (!this.cursor) return;
    g.strokeStyle = themeColour(this.canvas, "--cursor") || "#fff"; g.lineWidth = 1;
    if (this.isFan) { const { range, azimuth } = this.cursor; if (range !== undefined) this.arc(g, range, -Math.PI / 2, Math.PI / 2); if (azimuth !== undefined) this.line(g, 0, 0, 99 * Math.sin(azimuth), 99 * Math.cos(azimuth)); return; }
    const at = this.place(this.cursor);
    if (at.x !== undefined) this.line(g, at.x, this.y.from, at.x, this.y.to);
    if (at.y !== undefined) this.line(g, this.x.from, at.y, this.x.to, at.y);
  }
  private line(g: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void { g.beginPath(); g.moveTo(this.px(x0), this.py(y0)); g.lineTo(this.px(x1), this.py(y1)); g.stroke(); }
  private arc(g: CanvasRenderingContext2D, range: number, left: number, right: number): void {
    g.beginPath();
    for (let k = 0; k <= 40; k++) { const t = left + ((right - left) * k) / 40; g.lineTo(this.px(range * Math.sin(t)), this.py(range * Math.cos(t))); }
    g.stroke();
  }
  private trace(g: CanvasRenderingContext2D, { x, y }: Mark): void {
    if (this.isFan) {
      const [left, right] = x ?? [-1.6, 1.6], [near, far] = y ?? [0, this.y.to];
      for (const r of [near, far]) this.arc(g, r, left, right);
      for (const t of [left, right]) this.line(g, near * Math.sin(t), near * Math.cos(t), far * Math.sin(t), far * Math.cos(t));
      return;
    }
    const box = this.box(), x0 = x ? this.px(x[0]) : box.left - 5, x1 = x ? this.px(x[1]) : box.left + box.width + 5, y0 = y ? this.py(y[0]) : box.top - 5, y1 = y ? this.py(y[1]) : box.top + box.height + 5;
    g.strokeRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
  }
}

/** The text, cut with an ellipsis where it is wider than so many pixels. */
function fitted(g: CanvasRenderingContext2D, text: string, width: number): string {
  if (g.measureText(text).width <= width) return text;
  let end = text.length;
  while (end > 1 && g.measureText(`${text.slice(0, end)}…`).width > width) end--;
  return `${text.slice(0, end)}…`;
}

export interface Curve { values: Float32Array; colour: string; name: string; dashed?: boolean }

/** Curves over one quantity, such as the range profile. */
export class CurveChart extends Chart {
  private curves: Curve[] = [];
  private unit = "";
  private span: [number, number] = [0, 1];
  show(curves: Curve[], span: [number, number], unit: string): void { this.curves = curves; this.span = span; this.unit = unit; this.isStale = true; this.draw(); if (this.cursor) this.point(this.cursor); }
  protected step(): [number, number] { const count = this.curves[0]?.values.length ?? 1; return [(this.span[1] - this.span[0]) / count, (this.y.to - this.y.from) / 20]; }
  protected valueText(cursor: Cursor): string {
    const { x } = this.place(cursor), values = this.curves[0]?.values;
    if (x === undefined || !values) return "";
    const k = Math.floor(((x - this.span[0]) / (this.span[1] - this.span[0])) * values.length);
    return this.curves.filter((one) => !one.dashed && k in one.values).map((one) => `${one.name} ${one.values[k].toFixed(0)}`).join(", ").replace(/-/g, "−") + ` ${this.unit}`;
  }
  protected paint(g: CanvasRenderingContext2D, px: (x: number) => number, py: (y: number) => number): void {
    const line = themeColour(this.canvas, "--line"), box = this.box();
    g.strokeStyle = line; g.lineWidth = 0.5;
    for (const t of ticks(this.y.from, this.y.to, Math.max(2, box.height / 28))) { g.beginPath(); g.moveTo(box.left, py(t)); g.lineTo(box.left + box.width, py(t)); g.stroke(); }
    this.curves.forEach(({ values, colour, name, dashed }, n) => {
      g.strokeStyle = g.fillStyle = colour; g.lineWidth = 1.4; g.setLineDash(dashed ? [3, 3] : []); g.beginPath();
      const wide = (this.span[1] - this.span[0]) / values.length;
      values.forEach((value, k) => g.lineTo(px(this.span[0] + (k + 0.5) * wide), py(value)));
      g.stroke(); g.setLineDash([]); g.font = `${11 * this.scale}px ${FONT}`; g.textAlign = "right";
      g.fillText(name, box.left + box.width - 6, box.top + 13 * this.scale * (n + 1));
    });
  }
}
