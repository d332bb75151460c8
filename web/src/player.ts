// Plays one sequence, or two side by side: 3D view, maps, and the range-time map as the scrub bar.
import { clamp, element } from "./dom";
import { MapPanel, type Axis, type Mark, type Picture, type Pointer } from "./map_panel";
import { SceneView } from "./scene_view";
import { commonScale, RoomView, Sequence } from "./sequence";

const SPEEDS = [0.25, 0.5, 1, 2, 4];
const DEGREES = 180 / Math.PI;
const MAPS = [
  { name: "range_doppler", title: "Range-Doppler", kind: "doppler" },
  { name: "range_azimuth", title: "Range-azimuth, all", kind: "azimuth" },
  { name: "range_azimuth_moving", title: "Range-azimuth, moving", kind: "azimuth" },
  { name: "micro_doppler", title: "Micro-Doppler, moving", kind: "velocity-time" },
  { name: "range_time", title: "Range over time, clutter removed", kind: "range-time" },
] as const;
type Kind = (typeof MAPS)[number]["kind"];
type Which = "a" | "b" | "difference";
const NOW = "#7fe3ff";

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
  private panels: { map: string; kind: Kind; panel: MapPanel; which: Which }[] = [];
  private time: MapPanel | null = null;
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
    new ResizeObserver(() => this.draw()).observe(this.root);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    const tick = (now: number) => {
      if (this.playing && this.lead) {
        this.share += ((now - this.last) / 1000 / this.lead.periodS) * this.speed;
        if (this.share >= 1) { const whole = Math.floor(this.share); this.share -= whole; this.frame = (this.frame + whole) % this.lead.frames; this.draw(); }
        else this.showScene();
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
    this.frame = Math.min(this.frame, this.lead!.frames - 1); this.share = 0;
    this.scene.setSequence(sequence, other);
    this.root.classList.toggle("comparing", other !== null);
    this.build();
    this.draw();
  }

  /** The longer sequence, in whose frames the time line counts. */
  get lead(): Sequence | null { return this.other && this.other.durationS > this.sequence!.durationS ? this.other : this.sequence; }
  private frameOf(sequence: Sequence): number { return sequence === this.lead ? this.frame : sequence.frameAt(this.lead!.timeS(this.frame)); }

  /** The frame that each panel shows, for tests: all are equal. */
  shownFrames(): Record<string, number> {
    return { scene: this.drawnFrame.scene, ...Object.fromEntries(this.panels.map(({ map, which }) => [`${map}/${which}`, this.drawnFrame.maps])) };
  }
  private drawnFrame = { scene: 0, maps: 0 };

  panel(map: string): MapPanel | undefined { return this.panels.find((one) => one.map === map && one.which === "a")?.panel; }

  seek(frame: number): void {
    if (!this.lead) return;
    this.frame = clamp(Math.round(frame), 0, this.lead.frames - 1); this.share = 0;
    this.draw();
  }
  step(by: number): void { this.pause(); this.seek(this.frame + by); }
  toggle(): void { if (this.playing) this.pause(); else this.play(); }
  play(): void { this.playing = true; this.playButton.textContent = "❚❚"; this.playButton.setAttribute("aria-label", "Pause"); }
  pause(): void { this.playing = false; this.playButton.textContent = "▶"; this.playButton.setAttribute("aria-label", "Play"); }

  draw(): void {
    const a = this.sequence, b = this.other, lead = this.lead;
    if (!a || !lead) return;
    const scale = commonScale(a, b), low = scale.low + Number(this.slider.value) * (scale.high - scale.low - 5), window: [number, number] = [low, scale.high];
    this.sliderText.textContent = `${low.toFixed(0)} to ${scale.high.toFixed(0)} ${scale.unit}`;
    this.showScene();
    const now: Mark = { x: [lead.timeS(this.frame), lead.timeS(this.frame) + lead.periodS], colour: NOW };
    for (const { map, kind, panel, which } of this.panels) {
      panel.marks = [...(kind.endsWith("time") ? [now] : []), ...(this.wasInside ? bodyMarks(which === "b" ? b! : a, this.frameOf(which === "b" ? b! : a), kind) : [])];
      if (which === "difference") panel.drawDifference(this.picture(a, map, kind, scale.addA), this.picture(b!, map, kind, scale.addB));
      else panel.draw(which === "a" ? this.picture(a, map, kind, scale.addA) : this.picture(b!, map, kind, scale.addB), scale.unit, window);
    }
    this.drawnFrame.maps = this.frame;
    this.clock.textContent = `${lead.timeS(this.frame).toFixed(2)} / ${lead.durationS.toFixed(2)} s`;
    const bar = this.time!.canvas;
    for (const [name, value] of [["aria-valuemin", 0], ["aria-valuemax", lead.frames - 1], ["aria-valuenow", this.frame], ["aria-valuetext", `frame ${this.frame} of ${lead.frames}, ${lead.timeS(this.frame).toFixed(2)} seconds`]] as const) bar.setAttribute(name, String(value));
  }

  private showScene(): void {
    this.scene.showFrame(this.frameOf(this.sequence!), this.sequence === this.lead ? this.share : 0, this.other ? this.frameOf(this.other) : 0, this.other === this.lead ? this.share : 0);
    this.drawnFrame.scene = this.frame;
  }

  private picture(s: Sequence, map: string, kind: Kind, add: number): Picture {
    const scale = { low: s.db.low + add, high: s.db.high + add }, { range_m: range, velocity_mps: velocity, azimuth_rad: azimuth } = s.header, time: [number, number] = [0, s.durationS];
    if (kind === "velocity-time") return { tensor: s.map(map), at: 0, rows: "last", ...scale, across: time, up: velocity };
    if (kind === "range-time") return { tensor: s.map(map), at: 0, rows: "last", ...scale, across: time, up: range };
    return { tensor: s.map(map), at: this.frameOf(s), rows: "first", ...scale, across: kind === "doppler" ? velocity : [azimuth[0] * DEGREES, azimuth[1] * DEGREES], up: range };
  }

  private build(): void {
    const a = this.sequence!, b = this.other, endS = Math.max(a.durationS, b?.durationS ?? 0);
    this.panels = []; this.side.replaceChildren(); this.strip.replaceChildren();
    for (const { name, title, kind } of MAPS) {
      const row = element("div", { class: b || kind !== "velocity-time" ? "row" : "row wide" });
      for (const which of b ? (["a", "b", "difference"] as const) : (["a"] as const)) {
        const { across, up } = this.picture(which === "b" ? b! : a, name, kind, 0), isTime = kind.endsWith("time");
        const x: Axis = isTime ? { label: "time (s)", from: 0, to: endS } : { label: kind === "doppler" ? "radial velocity (m/s, away +)" : "azimuth (degrees, right +)", from: across[0], to: across[1] };
        const y: Axis = { label: kind === "velocity-time" ? "radial velocity (m/s)" : "range (m)", from: up[0], to: up[1] };
        const suffix = b ? { a: " (A)", b: " (B)", difference: ", B less A, ±20 dB" }[which] : "";
        const panel = new MapPanel(which === "difference" ? "B less A, ±20 dB" : title + suffix, x, y);
        panel.canvas.setAttribute("aria-label", `${title}${suffix}: ${y.label} against ${x.label}`);
        panel.onHover = (pointer) => this.hover(pointer, kind);
        if (isTime) panel.onPick = (pointer) => { this.pause(); this.seek(Math.floor(pointer.x / this.lead!.periodS)); };
        if (kind === "range-time") { this.strip.append(panel.root); if (which === "a") { this.time = panel; panel.canvas.setAttribute("role", "slider"); } }
        else row.append(panel.root);
        this.panels.push({ map: name, kind, panel, which });
      }
      if (kind !== "range-time") this.side.append(row);
    }
  }

  private hover(pointer: Pointer | null, kind: Kind): void {
    this.scene.showCell(pointer && kind !== "velocity-time" ? pointer.y : null, pointer && kind === "azimuth" ? pointer.x / DEGREES : null);
    this.draw();
  }

  private markBody(inside: boolean): void {
    if (inside === this.wasInside) return;
    this.wasInside = inside;
    this.draw();
  }
  private wasInside = false;

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName)) return;
    if (event.shiftKey) return;
    if (event.key === " " && target.tagName !== "BUTTON") this.toggle();
    else if (event.key === "ArrowLeft") this.step(-1);
    else if (event.key === "ArrowRight") this.step(1);
    else if (event.key === "Home" && target === this.time?.canvas) this.seek(0);
    else if (event.key === "End" && target === this.time?.canvas) this.seek(Infinity);
    else return;
    event.preventDefault();
  }
}

/** Rectangles around the cells that each body covers at a frame. */
function bodyMarks(sequence: Sequence, frame: number, kind: Kind): Mark[] {
  return sequence.bodyCells(frame).map(({ range, velocity, azimuth }) => {
    if (kind === "doppler") return { x: velocity, y: range };
    if (kind === "azimuth") return { x: [azimuth[0] * DEGREES, azimuth[1] * DEGREES], y: range };
    return { y: kind === "range-time" ? range : velocity, x: [sequence.timeS(frame), sequence.timeS(frame) + sequence.periodS] };
  });
}
