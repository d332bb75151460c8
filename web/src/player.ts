// Plays one sequence, or two side by side: 3D view, maps, and the range-time map as the scrub bar.
import { clamp, element } from "./dom";
import { MapPanel, type Axis, type Mark, type Pointer } from "./map_panel";
import { SceneView } from "./scene_view";
import { RoomView, Sequence } from "./sequence";

const SPEEDS = [0.25, 0.5, 1, 2, 4];
const DEGREES = 180 / Math.PI;
const MAPS = [
  { name: "range_doppler", title: "Range-Doppler", kind: "doppler" },
  { name: "range_azimuth", title: "Range-azimuth, all", kind: "azimuth" },
  { name: "range_azimuth_moving", title: "Range-azimuth, moving", kind: "azimuth" },
] as const;

export class Player {
  readonly root = element("div", { class: "player" });
  readonly scene = new SceneView();
  sequence: Sequence | null = null;
  other: Sequence | null = null;
  room: RoomView | null = null;
  frame = 0;
  playing = false;
  speed = 1;
  private side = element("div", { class: "maps", "aria-label": "Radar maps" });
  private panels: { map: string; panel: MapPanel; which: "a" | "b" | "difference" }[] = [];
  private doppler!: MapPanel;
  private time!: MapPanel;
  private playButton = element("button", { class: "round", "aria-label": "Play", title: "Play or pause (space)" }, "▶");
  private clock = element("output", { class: "clock", "aria-label": "Time" });
  private slider = element("input", { type: "range", min: 0, max: 1, step: 0.01, value: 0, "aria-label": "Weakest power shown" });
  private sliderText = element("output", { class: "slider-text" });
  private speedChoice = element("select", { "aria-label": "Speed" });
  private strip = element("div", { class: "strip" });
  private last = 0;
  private share = 0;

  constructor() {
    for (const speed of SPEEDS) this.speedChoice.append(element("option", { value: speed, selected: speed === 1 }, `${speed}×`));
    this.speedChoice.addEventListener("change", () => (this.speed = Number(this.speedChoice.value)));
    this.playButton.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => this.draw());
    const layers = element("fieldset", { class: "layers" }, element("legend", { class: "hidden" }, "What the 3D view shows"));
    for (const [layer, label, on] of [["room", "room", true], ["planes", "walls, reflectors", false], ["free", "free floor", true], ["points", "radar points", true], ["trail", "path", true]] as const) {
      const box = element("input", { type: "checkbox", checked: on });
      box.addEventListener("change", () => this.scene.show(layer, box.checked));
      layers.append(element("label", {}, box, ` ${label}`));
    }
    this.scene.root.append(layers);
    const stepper = (by: number, label: string, text: string) => element("button", { class: "round", "aria-label": label, title: label, click: () => this.step(by) }, text);
    const bar = element("div", { class: "transport" }, stepper(-1, "Previous frame (left arrow)", "◀"), this.playButton, stepper(1, "Next frame (right arrow)", "▶|"), this.speedChoice, this.clock,
      element("label", { class: "scale" }, "power from ", this.slider, this.sliderText));
    this.root.append(this.scene.root, this.side, element("div", { class: "bottom" }, bar, this.strip));
    this.root.addEventListener("keydown", (event) => this.key(event));
    this.scene.onBody = (inside) => this.markBody(inside);
    this.time = this.timePanel("Range over time, clutter removed", { label: "range (m)", from: 0, to: 1 });
    this.strip.append(this.time.root);
    this.time.canvas.setAttribute("role", "slider");
    new ResizeObserver(() => this.draw()).observe(this.root);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    const tick = (now: number) => {
      if (this.playing && this.sequence) {
        this.share += ((now - this.last) / 1000 / this.sequence.periodS) * this.speed;
        if (this.share >= 1) { const whole = Math.floor(this.share); this.share -= whole; this.frame = (this.frame + whole) % this.sequence.frames; this.draw(); }
        else this.scene.showFrame(this.frame, this.share);
      }
      this.last = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  setRoom(room: RoomView | null): void { this.room = room; this.scene.setRoom(room); }

  /** Shows a sequence; with `other` the two are compared on one time line and one scale. */
  show(sequence: Sequence, other: Sequence | null = null): void {
    this.sequence = sequence; this.other = other;
    this.frame = Math.min(this.frame, sequence.frames - 1); this.share = 0;
    this.scene.setSequence(sequence);
    this.root.classList.toggle("comparing", other !== null);
    this.build();
    this.draw();
  }

  /** The frame that each panel shows, for tests: all are equal. */
  shownFrames(): Record<string, number> {
    return { scene: this.drawnFrame.scene, ...Object.fromEntries(this.panels.map(({ map, which }) => [`${map}/${which}`, this.drawnFrame.maps])), time: this.drawnFrame.time };
  }
  private drawnFrame = { scene: 0, maps: 0, time: 0 };

  panel(map: string): MapPanel | undefined { return this.panels.find((one) => one.map === map && one.which === "a")?.panel; }

  seek(frame: number): void {
    if (!this.sequence) return;
    this.frame = clamp(Math.round(frame), 0, this.sequence.frames - 1); this.share = 0;
    this.draw();
  }
  step(by: number): void { this.pause(); this.seek(this.frame + by); }
  toggle(): void { if (this.playing) this.pause(); else this.play(); }
  play(): void { this.playing = true; this.playButton.textContent = "❚❚"; this.playButton.setAttribute("aria-label", "Pause"); }
  pause(): void { this.playing = false; this.playButton.textContent = "▶"; this.playButton.setAttribute("aria-label", "Play"); }

  draw(): void {
    const a = this.sequence;
    if (!a) return;
    const b = this.other, scale = { low: Math.min(a.db.low, b?.db.low ?? Infinity), high: Math.max(a.db.high, b?.db.high ?? -Infinity) };
    const low = scale.low + Number(this.slider.value) * (scale.high - scale.low - 5), window: [number, number] = [low, scale.high];
    this.sliderText.textContent = `${low.toFixed(0)} to ${scale.high.toFixed(0)} ${a.db.unit}`;
    this.scene.showFrame(this.frame, this.share);
    this.drawnFrame.scene = this.frame;
    for (const { map, panel, which } of this.panels) {
      const frameB = b ? Math.min(this.frame, b.frames - 1) : 0;
      if (which === "difference") panel.drawDifference({ tensor: a.map(map), at: this.frame, rows: "first" }, { tensor: b!.map(map), at: frameB, rows: "first" }, a.db, b!.db);
      else { const s = which === "a" ? a : b!; panel.draw({ tensor: s.map(map), at: which === "a" ? this.frame : frameB, rows: "first" }, s.db, window); }
    }
    this.drawnFrame.maps = this.frame;
    const now: Mark[] = [{ x: [a.timeS(this.frame), a.timeS(this.frame) + a.periodS], colour: "#7fe3ff" }];
    for (const panel of [this.doppler, this.time]) panel.marks = now;
    this.doppler.draw({ tensor: a.map("micro_doppler"), at: 0, rows: "last" }, a.db, window);
    this.time.draw({ tensor: a.map("range_time"), at: 0, rows: "last" }, a.db, window);
    this.drawnFrame.time = this.frame;
    const end = a.frames * a.periodS;
    this.clock.textContent = `${a.timeS(this.frame).toFixed(2)} / ${end.toFixed(2)} s`;
    const bar = this.time.canvas;
    for (const [name, value] of [["aria-valuemin", 0], ["aria-valuemax", a.frames - 1], ["aria-valuenow", this.frame], ["aria-valuetext", `frame ${this.frame} of ${a.frames}, ${a.timeS(this.frame).toFixed(2)} seconds`]] as const) bar.setAttribute(name, String(value));
  }

  private build(): void {
    const a = this.sequence!, range: Axis = { label: "range (m)", from: a.header.range_m[0], to: a.header.range_m[1] };
    const columns = { doppler: { label: "radial velocity (m/s, away +)", from: a.header.velocity_mps[0], to: a.header.velocity_mps[1] }, azimuth: { label: "azimuth (degrees, right +)", from: a.header.azimuth_rad[0] * DEGREES, to: a.header.azimuth_rad[1] * DEGREES } };
    this.panels = []; this.side.replaceChildren();
    for (const { name, title, kind } of MAPS) {
      const same = this.other && String(this.other.map(name).shape.slice(1)) === String(a.map(name).shape.slice(1));
      const kinds = this.other ? (same ? (["a", "b", "difference"] as const) : (["a", "b"] as const)) : (["a"] as const);
      const row = element("div", { class: "row" });
      for (const which of kinds) {
        const s = which === "b" ? this.other! : a;
        const y = which === "b" ? { ...range, from: s.header.range_m[0], to: s.header.range_m[1] } : range;
        const suffix = this.other ? { a: " (A)", b: " (B)", difference: ", B less A, ±20 dB" }[which] : "";
        const panel = new MapPanel(which === "difference" ? "B less A, ±20 dB" : title + suffix, columns[kind], y);
        panel.canvas.setAttribute("aria-label", `${title}${suffix}: ${y.label} against ${columns[kind].label}`);
        panel.onHover = (pointer) => this.hover(pointer, kind);
        row.append(panel.root); this.panels.push({ map: name, panel, which });
      }
      this.side.append(row);
    }
    this.doppler = this.timePanel("Micro-Doppler, moving", { label: "radial velocity (m/s)", from: a.header.velocity_mps[0], to: a.header.velocity_mps[1] });
    this.side.append(element("div", { class: "row wide" }, this.doppler.root));
    for (const panel of [this.doppler, this.time]) panel.x = { label: "time (s)", from: 0, to: a.frames * a.periodS };
    this.time.y = range;
  }

  private timePanel(title: string, y: Axis): MapPanel {
    const panel = new MapPanel(title, { label: "time (s)", from: 0, to: 1 }, y);
    panel.canvas.setAttribute("aria-label", title);
    panel.onPick = (pointer) => { this.pause(); this.seek(Math.floor(pointer.x / this.sequence!.periodS)); };
    panel.onHover = () => this.draw();
    return panel;
  }

  private hover(pointer: Pointer | null, kind: "doppler" | "azimuth"): void {
    this.scene.showCell(pointer ? pointer.y : null, pointer && kind === "azimuth" ? pointer.x / DEGREES : null);
    this.draw();
  }

  private markBody(inside: boolean): void {
    const span = inside ? this.sequence?.bodyRange(this.frame) : null;
    for (const { panel } of this.panels) panel.marks = span ? [{ y: span }] : [];
    if (inside !== this.wasInside) { this.wasInside = inside; this.draw(); }
  }
  private wasInside = false;

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName)) return;
    if (event.key === " " && target.tagName !== "BUTTON") this.toggle();
    else if (event.key === "ArrowLeft") this.step(-1);
    else if (event.key === "ArrowRight") this.step(1);
    else if (event.key === "Home" && target === this.time.canvas) this.seek(0);
    else if (event.key === "End" && target === this.time.canvas) this.seek(Infinity);
    else return;
    event.preventDefault();
  }
}
