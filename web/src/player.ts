// Plays one sequence, or two side by side: 3D view, linked maps on one colour bar, and range over time as the scrub bar.
import { LIVING_PALE, PEOPLE } from "./body";
import { CurveChart, type Axis, type Chart, type Cursor, type Mark } from "./chart";
import { colourTable, velocityColour } from "./colours";
import { clamp, element } from "./dom";
import { differences, motionLine, noiseChip, warnings } from "./facts";
import { DIFFERENCE_DB, MapPanel, type Picture } from "./map_panel";
import { inCell, legend, type CellSize, type Rays } from "./rays";
import { SceneView, TOP_SPEED_MPS, type Layer } from "./scene_view";
import { commonScale, RoomView, Sequence } from "./sequence";
import { remembered } from "./settings";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const DEGREES = 180 / Math.PI;
const MAPS = [
  { name: "range_doppler", title: "Range-Doppler", kind: "doppler" },
  { name: "range_azimuth", title: "Range-azimuth", kind: "azimuth" },
  { name: "range_profile", title: "Range profile", kind: "profile" },
  { name: "range_time", title: "Range over time, moving", kind: "range-time" },
  { name: "micro_doppler", title: "Micro-Doppler, moving", kind: "velocity-time" },
] as const;
type MapName = (typeof MAPS)[number]["name"];
type Kind = (typeof MAPS)[number]["kind"];
type Which = "a" | "b" | "difference";
const LAYERS: [Layer, string][] = [["room", "room"], ["points", "moving points"], ["static", "static points"], ["trail", "path"], ["view", "field of view"], ["grid", "range rings"], ["free", "free floor"], ["planes", "walls, reflectors"], ["camera", "camera"]];
const NOW = "#7fe3ff", ALL_COLOUR = "#9b6a12", MOVING_COLOUR = "#0b7da3";

interface Panel { map: MapName; kind: Kind; which: Which; chart: Chart }

export class Player {
  readonly root = element("div", { class: "player" });
  readonly scene = new SceneView();
  readonly settings = remembered("mmweaver.view", { speed: 1, loop: true, moving: false, weakest: 0, layers: ["room", "points", "trail", "view", "grid"] as Layer[], maps: MAPS.map((one) => one.name) as MapName[], rays: false });
  /** Traces the paths of a frame, where there is somebody who can. */
  tracer: ((sequence: Sequence, frame: number) => Promise<Rays | null>) | null = null;
  /** Lets a person show where a thing is that the photo does not show, where that is possible. */
  mark: ((kind: string) => void) | null = null;
  sequence: Sequence | null = null;
  other: Sequence | null = null;
  room: RoomView | null = null;
  frame = 0;
  playing = false;
  cursor: Cursor | null = null;
  cell: Cursor | null = null;
  rays: Rays | null = null;
  private panels: Panel[] = [];
  private maps = element("div", { class: "maps", "aria-label": "Radar maps" });
  private strips = element("div", { class: "strips" });
  private facts = element("ul", { class: "facts", "aria-label": "What became of the sentence, and warnings" });
  private names = element("div", { class: "names" });
  private raysInfo = element("div", { class: "rays", hidden: true, "aria-live": "polite" });
  private time: Chart | null = null;
  private playButton = element("button", { class: "round", "aria-label": "Play", title: "Play or pause (space)" }, "▶");
  private loopButton = element("button", { class: "round", title: "Loop (L)", "aria-label": "Loop", "aria-pressed": "true" }, "↻");
  private movingBox = element("input", { type: "checkbox" });
  private raysBox = element("input", { type: "checkbox" });
  private clock = element("output", { class: "clock", "aria-label": "Time" });
  private reading = element("output", { class: "reading", "aria-label": "Cursor" });
  private slider = element("input", { type: "range", min: 0, max: 1, step: 0.01, value: 0, "aria-label": "Weakest power shown" });
  private bar = element("div", { class: "colour-bar" });
  private speedChoice = element("select", { "aria-label": "Speed" });
  private last = 0;
  private share = 0;
  private isInside = false;
  private isTracing = false;
  private raysAt = "";
  private shown = { scene: 0, maps: 0, key: "" };

  constructor() {
    const { settings } = this;
    for (const speed of SPEEDS) this.speedChoice.append(element("option", { value: speed, selected: speed === settings.value.speed }, `${speed}×`));
    this.speedChoice.addEventListener("change", () => settings.set({ speed: Number(this.speedChoice.value) }));
    this.playButton.addEventListener("click", () => this.toggle());
    this.loopButton.addEventListener("click", () => this.setLoop(!settings.value.loop)); this.setLoop(settings.value.loop);
    this.slider.value = String(settings.value.weakest);
    this.slider.addEventListener("input", () => { settings.set({ weakest: Number(this.slider.value) }); this.draw(); });
    this.movingBox.checked = settings.value.moving; this.movingBox.addEventListener("change", () => this.setMoving(this.movingBox.checked));
    this.raysBox.checked = settings.value.rays; this.raysBox.addEventListener("change", () => this.setRays(this.raysBox.checked));
    const stepper = (by: number, label: string, text: string) => element("button", { class: "round", "aria-label": label, title: label, click: () => this.step(by) }, text);
    const transport = element("div", { class: "transport" }, stepper(-1, "Previous frame (left arrow)", "◀"), this.playButton, stepper(1, "Next frame (right arrow)", "▶|"), this.loopButton, this.speedChoice, this.clock, this.reading);
    const mapsTop = element("div", { class: "maps-top" }, this.bar, element("label", { class: "scale" }, "from ", this.slider), element("label", { title: "Cells that move (M)" }, this.movingBox, " moving only"));
    this.scene.root.append(this.layersMenu(), this.names, this.raysInfo, velocityBar());
    this.root.append(this.facts, element("div", { class: "view" }, this.scene.root, transport), element("div", { class: "side" }, mapsTop, this.maps), this.strips);
    this.root.addEventListener("keydown", (event) => this.key(event));
    this.scene.onBody = (inside) => { if (inside !== this.isInside) { this.isInside = inside; this.draw(); } };
    new ResizeObserver(() => this.draw()).observe(this.root);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.themeChanged());
  }

  /** Runs while it plays; in software once for each frame, since a picture of the page costs the processor as much as one of the room. */
  private tick = (): void => {
    if (!this.playing) return;
    const now = performance.now();
    if (this.lead) this.advance((now - this.last) / 1000);
    this.last = now;
    if (this.scene.isSoftware && this.lead) setTimeout(() => requestAnimationFrame(this.tick), Math.max(4, (1 - this.share) * this.lead.periodS * 1000 / this.settings.value.speed - 8)); else requestAnimationFrame(this.tick);
  };

  private advance(seconds: number): void {
    const { lead } = this, { speed, loop } = this.settings.value;
    this.share += (seconds / lead!.periodS) * speed;
    if (this.share < 1) { if (!this.scene.isSoftware) this.showScene(); return; } // in software a picture for each frame
    const whole = Math.floor(this.share), next = this.frame + whole;
    this.share -= whole;
    if (next >= lead!.frames && !loop) { this.frame = lead!.frames - 1; this.share = 0; this.pause(); } else this.frame = next % lead!.frames;
    this.draw();
  }

  private layersMenu(): HTMLElement {
    const boxes = LAYERS.map(([layer, label]) => {
      const box = element("input", { type: "checkbox", checked: this.settings.value.layers.includes(layer) });
      this.scene.show(layer, box.checked);
      box.addEventListener("change", () => {
        this.settings.set({ layers: LAYERS.map(([name]) => name).filter((name) => (name === layer ? box.checked : this.settings.value.layers.includes(name))) });
        this.scene.show(layer, box.checked);
      });
      return element("label", {}, box, ` ${label}`);
    });
    const maps = MAPS.map(({ name, title }) => {
      const box = element("input", { type: "checkbox", checked: this.settings.value.maps.includes(name) });
      box.addEventListener("change", () => { this.settings.set({ maps: MAPS.map((one) => one.name).filter((one) => (one === name ? box.checked : this.settings.value.maps.includes(one))) }); if (this.sequence) { this.build(); this.draw(); } });
      return element("label", {}, box, ` ${title}`);
    });
    return element("div", { class: "layers" },
      element("details", {}, element("summary", {}, "Layers"), element("fieldset", {}, element("legend", { class: "hidden" }, "What the 3D view shows"), ...boxes), element("fieldset", {}, element("legend", {}, "Panels"), ...maps)),
      element("label", { class: "rays-switch", title: "Propagation paths of this frame (R)" }, this.raysBox, " rays"),
      element("button", { class: "small", title: "Reset the view (0)", click: () => this.scene.home() }, "Reset view"));
  }

  setRoom(room: RoomView | null): void { this.room = room; this.scene.setRoom(room); }
  clear(): void { this.sequence = this.other = null; this.panels = []; this.maps.replaceChildren(); this.strips.replaceChildren(); this.facts.replaceChildren(); this.names.replaceChildren(); this.clock.textContent = ""; this.rays = null; this.showRays(); this.scene.setSequence(null); this.shown.key = ""; }

  /** Shows a sequence; with `other` the two are compared on one time line and one scale. */
  show(sequence: Sequence, other: Sequence | null = null): void {
    const key = (one: Sequence | null) => JSON.stringify(one && [one.header.range_m, one.header.velocity_mps, one.header.azimuth_rad, one.spanS]), isBuilt = this.shown.key === key(sequence) + key(other) && this.panels.length;
    this.shown.key = key(sequence) + key(other);
    this.sequence = sequence; this.other = other; this.rays = null; this.raysAt = ""; if (!sequence.version) this.cell = null;
    this.frame = Math.min(this.frame, this.lead!.frames - 1); this.share = 0;
    this.scene.setSequence(sequence, other);
    this.root.classList.toggle("comparing", other !== null);
    if (!isBuilt) this.build();
    this.facts.replaceChildren(...motionLine((other ?? sequence).header.meta, this.mark), ...[sequence, ...(other ? [other] : [])].flatMap(warnings), ...noiseChip(other ?? sequence));
    this.showNames();
    this.showRays();
    this.draw();
  }
  /** Who is A, who is B, or who acts, with colours. */
  private showNames(): void {
    const told = (shift: number, name: string) => element("span", {}, element("span", { class: "swatch", style: `background:${PEOPLE[shift]}` }), name), [a, b] = this.other ? differences(this.sequence!, this.other) : ["", ""];
    this.names.replaceChildren(...(this.other ? [told(0, `A: ${a}`), told(LIVING_PALE, `B: ${b}`)] : []));
  }

  /** The longer sequence, in whose frames the time line counts. */
  get lead(): Sequence | null { return this.other && this.other.durationS > this.sequence!.durationS ? this.other : this.sequence; }
  private frameOf(sequence: Sequence): number { return sequence === this.lead ? this.frame : sequence.frameAt(this.lead!.timeS(this.frame)); }

  /** The frame that each panel shows, for tests: all are equal. */
  shownFrames(): Record<string, number> { return { scene: this.shown.scene, ...Object.fromEntries(this.panels.map(({ map, which }) => [`${map}/${which}`, this.shown.maps])) }; }
  panel(map: string, which: Which = "a"): Chart | undefined { return this.panels.find((one) => one.map === map && one.which === which)?.chart; }

  drawnPanels(): { canvas: HTMLCanvasElement; chart: Chart }[] { return this.panels.map(({ chart }) => ({ canvas: chart.canvas, chart })); }

  seek(frame: number): void {
    if (!this.lead) return;
    this.frame = clamp(Math.round(frame), 0, this.lead.frames - 1); this.share = 0;
    this.draw();
  }
  step(by: number): void { this.pause(); this.seek(this.frame + by); }
  toggle(): void { if (this.playing) this.pause(); else this.play(); }
  play(): void { if (this.playing) return; this.last = performance.now(); requestAnimationFrame(this.tick); this.playing = true; this.playButton.textContent = "❚❚"; this.playButton.setAttribute("aria-label", "Pause"); }
  pause(): void { this.playing = false; this.playButton.textContent = "▶"; this.playButton.setAttribute("aria-label", "Play"); }
  setLoop(on: boolean): void { this.settings.set({ loop: on }); this.loopButton.setAttribute("aria-pressed", String(on)); }
  setMoving(on: boolean): void { this.settings.set({ moving: on }); this.movingBox.checked = on; this.draw(); }
  setRays(on: boolean): void { this.settings.set({ rays: on }); this.raysBox.checked = on; if (!on) { this.cell = null; this.rays = null; this.raysAt = ""; } this.showRays(); this.draw(); }
  themeChanged(): void { for (const { chart } of this.panels) chart.redraw(); this.scene.themeChanged(); this.draw(); }

  draw(): void {
    const a = this.sequence, b = this.other, lead = this.lead;
    if (!a || !lead) return;
    const scale = commonScale(a, b), low = scale.low + Number(this.slider.value) * (scale.high - scale.low - 5), window: [number, number] = [low, scale.high];
    this.drawBar(scale, low);
    this.showScene();
    const now: Mark = { x: [lead.timeS(this.frame), lead.timeS(this.frame) + lead.periodS], colour: NOW };
    for (const { map, kind, chart, which } of this.panels) {
      const of = which === "b" ? b! : a;
      chart.marks = [...(kind.endsWith("time") ? [now] : []), ...(this.cell ? cellMark(this.cell, this.cellSize(a), kind) : []), ...(this.isInside ? bodyMarks(of, this.frameOf(of), kind) : [])];
      if (chart instanceof CurveChart) this.drawProfile(chart, which === "difference" ? null : of, which === "b" ? scale.addB : scale.addA, scale);
      else if (chart instanceof MapPanel && which === "difference") chart.showDifference(this.picture(a, map, kind, scale.addA), this.picture(b!, map, kind, scale.addB), window);
      else if (chart instanceof MapPanel) chart.show(this.picture(of, map, kind, which === "b" ? scale.addB : scale.addA), scale.unit, window);
    }
    this.shown.maps = this.frame;
    this.clock.textContent = `${lead.timeS(this.frame).toFixed(2)} / ${lead.durationS.toFixed(2)} s, frame ${this.frame + 1} of ${lead.frames}, ${(1 / lead.periodS).toFixed(0)} frames/s`;
    const bar = this.time?.canvas;
    if (bar) for (const [name, value] of [["aria-valuemin", 0], ["aria-valuemax", lead.frames - 1], ["aria-valuenow", this.frame], ["aria-valuetext", `frame ${this.frame} of ${lead.frames}, ${lead.timeS(this.frame).toFixed(2)} seconds`]] as const) bar.setAttribute(name, String(value));
    void this.trace();
  }

  private showScene(): void {
    const a = this.sequence!, b = this.other;
    this.scene.showFrame(this.frameOf(a), a === this.lead ? this.share : 0, b ? this.frameOf(b) : 0, b === this.lead ? this.share : 0);
    this.shown.scene = this.frame;
  }
  private drawBar(scale: { high: number; unit: string }, low: number): void {
    const key = `${low.toFixed(1)} ${scale.high.toFixed(1)} ${scale.unit} ${this.other !== null}`;
    if (this.bar.dataset.key === key) return;
    this.bar.dataset.key = key;
    const minus = (value: number) => value.toFixed(0).replace("-", "−");
    const one = (table: string, from: string, to: string, unit: string) => element("span", { class: "bar" }, element("span", {}, from), element("span", { class: "gradient", style: `background:${gradient(table)}` }), element("span", {}, `${to} ${unit}`));
    this.bar.replaceChildren(one("inferno", minus(low), minus(scale.high), scale.unit), ...(this.other ? [one("coolwarm", `−${DIFFERENCE_DB}`, `+${DIFFERENCE_DB}`, "dB, B − A")] : []));
  }
  private drawProfile(chart: CurveChart, of: Sequence | null, add: number, scale: { low: number; high: number; unit: string }): void {
    const [near, far] = this.sequence!.header.range_m;
    if (!of) { // B − A of what is not moved out
      const a = profile(this.sequence!, this.source("range_doppler"), this.frameOf(this.sequence!), 0), b = profile(this.other!, this.source("range_doppler"), this.frameOf(this.other!), 0), same = a.length === b.length;
      const { addA, addB } = commonScale(this.sequence!, this.other);
      chart.show(same ? [{ values: a.map((value, k) => b[k] + addB - value - addA), colour: MOVING_COLOUR, name: "B − A" }] : [], [near, far], "dB");
      return;
    }
    const frame = this.frameOf(of), all = profile(of, "range_doppler", frame, add), moving = profile(of, "range_doppler_moving", frame, add);
    chart.show([{ values: all, colour: ALL_COLOUR, name: "all" }, { values: moving, colour: MOVING_COLOUR, name: "moving" }, { values: new Float32Array(all.length).fill(of.db.noise + add), colour: "#8a8f96", name: "noise", dashed: true }], of.header.range_m, scale.unit);
  }
  private source(map: string): string { return this.settings.value.moving ? `${map}_moving` : map; }
  private picture(s: Sequence, map: MapName, kind: Kind, add: number): Picture {
    const scale = { low: s.db.low + add, high: s.db.high + add, version: s.version }, { range_m: range, velocity_mps: velocity, azimuth_rad: azimuth } = s.header, time: [number, number] = [0, s.durationS];
    if (kind === "velocity-time") return { tensor: s.map(map), at: 0, rows: "last", ...scale, across: time, up: velocity };
    if (kind === "range-time") return { tensor: s.map(map), at: 0, rows: "last", ...scale, across: time, up: range };
    return { tensor: s.map(this.source(map)), at: this.frameOf(s), rows: "first", ...scale, across: kind === "doppler" ? velocity : azimuth, up: range };
  }

  private build(): void {
    const a = this.sequence!, b = this.other, endS = Math.max(a.spanS, b?.spanS ?? 0), scale = commonScale(a, b);
    this.panels = []; this.maps.replaceChildren(); this.strips.replaceChildren(); this.time = null;
    for (const { name, title, kind } of MAPS) {
      if (!this.settings.value.maps.includes(name) && kind !== "range-time") continue;
      for (const which of b ? (["a", "b", "difference"] as const) : (["a"] as const)) {
        const [x, y] = axes(which === "b" ? b! : a, kind, endS, which === "difference" ? { low: -DIFFERENCE_DB, high: DIFFERENCE_DB, unit: "dB" } : scale);
        const name2 = b ? { a: `A: ${title}`, b: `B: ${title}`, difference: `B − A: ${title}` }[which] : title, chart = kind === "profile" ? new CurveChart(name2, x, y) : new MapPanel(name2, x, y);
        chart.isFan = kind === "azimuth";
        chart.canvas.setAttribute("aria-label", `${name2}: ${y.label} against ${x.label}. Shift and the arrow keys move the cursor.`);
        chart.onHover = (cursor) => this.hover(cursor);
        chart.onPick = (cursor, isDrag) => {
          if (kind.endsWith("time")) { this.pause(); this.seek(Math.floor(cursor.time! / this.lead!.periodS)); }
          else if (!isDrag && this.tracer) { this.cell = cursor; this.setRays(true); }
        };
        if (kind === "range-time" && which === "a") { this.time = chart; chart.canvas.setAttribute("role", "slider"); }
        (kind.endsWith("time") ? this.strips : this.maps).append(chart.root);
        this.panels.push({ map: name, kind, chart, which });
      }
    }
    this.strips.dataset.count = String(this.strips.childElementCount);
  }

  /** The cursor of one panel in all of them, in the room, and in words. */
  private hover(cursor: Cursor | null): void {
    this.cursor = cursor;
    const { range, velocity, azimuth, time } = cursor ?? {};
    this.scene.showCell(range ?? null, azimuth ?? null);
    for (const { chart } of this.panels) chart.point(cursor);
    this.reading.textContent = [range !== undefined && `${range.toFixed(2)} m`, velocity !== undefined && `${velocity.toFixed(2)} m/s`, azimuth !== undefined && `${(azimuth * DEGREES).toFixed(0)}°`, time !== undefined && `${time.toFixed(2)} s`].filter(Boolean).join("   ").replace(/-/g, "−");
  }

  // rays ------------------------------------------------------------------------------------------------------------
  private cellSize(s: Sequence): CellSize {
    const { range_m: [near, far], velocity_mps: [slow, fast] } = s.header, [, ranges, velocities] = s.arrays.range_doppler.shape;
    return { range: (1.5 * (far - near)) / ranges, velocity: (1.5 * (fast - slow)) / velocities, azimuth: 8 / DEGREES }; // a cell and what leaks into it
  }
  /** Asks for the paths of the frame that is shown, one question at a time. */
  private async trace(): Promise<void> {
    const s = this.other ?? this.sequence, frame = s && this.frameOf(s), key = `${s?.header.result} ${frame}`;
    this.raysBox.parentElement!.hidden = !this.tracer || !s?.header.result;
    if (!this.settings.value.rays || !this.tracer || !s?.header.result || this.isTracing || this.raysAt === key) return;
    this.isTracing = true; this.raysAt = key;
    try { this.rays = await this.tracer(s, frame!); } catch { this.rays = null; } finally { this.isTracing = false; }
    this.showRays();
    void this.trace(); // the frame may have gone on meanwhile
  }
  private showRays(): void {
    const { rays, cell } = this, isOn = this.settings.value.rays && rays !== null, chosen = isOn && cell ? inCell(rays, cell, this.cellSize(this.sequence!)) : null;
    this.scene.showRays(isOn ? rays : null, chosen);
    this.raysInfo.hidden = !isOn;
    if (isOn) this.raysInfo.replaceChildren(...legend(rays, chosen), ...(cell ? [element("button", { class: "small", click: () => { this.cell = null; this.showRays(); this.draw(); } }, "All paths")] : []));
  }

  /** Keys that hold wherever the focus is, but in boxes to type in. */
  key(event: KeyboardEvent): boolean {
    const target = event.target as HTMLElement, isTyping = target.matches("input:not([type=checkbox]):not([type=range]), select, textarea, [contenteditable]");
    if (isTyping || event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || event.shiftKey) return false;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1), Home: () => this.seek(0), End: () => this.seek(Infinity),
      l: () => this.setLoop(!this.settings.value.loop), m: () => this.setMoving(!this.settings.value.moving), r: () => { if (this.tracer) this.setRays(!this.settings.value.rays); }, "0": () => this.scene.home(),
      Escape: () => { this.cell = null; this.showRays(); this.hover(null); this.draw(); },
    };
    if (event.key === " " && !target.matches("button, summary, input")) this.toggle();
    else if (target.matches("input[type=range]") && event.key.startsWith("Arrow")) return false;
    else if (actions[event.key]) actions[event.key]();
    else return false;
    event.preventDefault(); event.stopPropagation();
    return true;
  }
}

function axes(s: Sequence, kind: Kind, endS: number, scale: { low: number; high: number; unit: string }): [Axis, Axis] {
  const { range_m: [near, far], velocity_mps: [slow, fast], azimuth_rad: [, right] } = s.header, wide = far * Math.sin(Math.min(right, Math.PI / 2));
  const range: Axis = { label: "range (m)", from: near, to: far, quantity: "range" }, time: Axis = { label: "time (s)", from: 0, to: endS, quantity: "time" };
  const velocity: Axis = { label: "radial velocity (m/s), away +", from: slow, to: fast, quantity: "velocity" };
  if (kind === "doppler") return [velocity, range];
  if (kind === "azimuth") return [{ label: "right (m)", from: -wide, to: wide }, { label: "ahead (m)", from: 0, to: far }];
  if (kind === "profile") return [range, { label: scale.unit, from: scale.low, to: scale.high + (scale.high - scale.low) * 0.05 }];
  return [time, kind === "range-time" ? range : { ...velocity, label: "velocity (m/s)" }];
}
/** The strongest velocity at each range of a frame, in decibels. */
function profile(s: Sequence, map: string, frame: number, add: number): Float32Array {
  const { data, shape: [, ranges, velocities] } = s.map(map), out = new Float32Array(ranges), { low, high } = s.db;
  for (let r = 0; r < ranges; r++) {
    let top = 0;
    for (let v = 0, o = (frame * ranges + r) * velocities; v < velocities; v++) if (data[o + v] > top) top = data[o + v];
    out[r] = low + add + (top / 255) * (high - low);
  }
  return out;
}
function cellMark(cell: Cursor, size: CellSize, kind: Kind): Mark[] {
  const span = (at: number | undefined, by: number): [number, number] | undefined => (at === undefined ? undefined : [at - by, at + by]), colour = "#ffffff";
  if (kind === "doppler") return [{ x: span(cell.velocity, size.velocity), y: span(cell.range, size.range), colour }];
  if (kind === "azimuth") return [{ x: span(cell.azimuth, size.azimuth), y: span(cell.range, size.range), colour }];
  return kind === "profile" ? [{ x: span(cell.range, size.range), colour: MOVING_COLOUR }] : [];
}
/** Rectangles around the cells that each body covers at a frame. */
function bodyMarks(sequence: Sequence, frame: number, kind: Kind): Mark[] {
  return sequence.bodyCells(frame).map(({ range, velocity, azimuth }) => {
    if (kind === "doppler") return { x: velocity, y: range };
    if (kind === "azimuth") return { x: azimuth, y: range };
    if (kind === "profile") return { x: range, colour: MOVING_COLOUR };
    return { y: kind === "range-time" ? range : velocity, x: [sequence.timeS(frame), sequence.timeS(frame) + sequence.periodS] };
  });
}
function gradient(name: string): string {
  const table = colourTable(name);
  return `linear-gradient(90deg,${Array.from({ length: 17 }, (_, k) => `rgb(${[...table.subarray(Math.min(k * 16, 255) * 4, Math.min(k * 16, 255) * 4 + 3)]})`)})`;
}
function velocityBar(): HTMLElement {
  const stops = Array.from({ length: 9 }, (_, k) => `rgb(${velocityColour((k / 4 - 1) * TOP_SPEED_MPS, TOP_SPEED_MPS).map((c) => Math.round(255 * c ** (1 / 2.2)))})`);
  return element("div", { class: "velocity-bar bar", title: "Colour of radar points: radial velocity" }, element("span", {}, `−${TOP_SPEED_MPS}`), element("span", { class: "gradient", style: `background:linear-gradient(90deg,${stops})` }), element("span", {}, `+${TOP_SPEED_MPS} m/s, away +`));
}
