// The studio: a sentence, a room and a radar in; the player shows what comes out.
import { Api, Refused } from "./api";
import { details, numbers } from "./drawer";
import { download, element } from "./dom";
import { filesOfDrop, filesOfInput, uploadForm, type Dropped } from "./drops";
import { Player } from "./player";
import { joined, RoomView, Sequence } from "./sequence";
import { unpack } from "./wire";

const LIVE_CHUNKS = 12; // of the rolling picture
const HISTORY = "mmweaver.sentences", MAX_HISTORY = 30;
interface Asked { room: string; text: string[]; radar: string; board?: string; method: string; seed: number; at: [number, number] | null; path: [number, number][] | null; motion: string; recogniser: string }

export class Studio {
  readonly root = element("main", { class: "mmweaver studio" });
  readonly player = new Player();
  ready = false;
  result: Sequence | null = null;
  live: any = null;
  lastSeconds = 0;
  private api = new Api();
  private text = element("input", { class: "sentence", type: "text", list: "mmweaver-sentences", "aria-label": "What the person does", spellcheck: "false", autocomplete: "off" });
  private second = element("input", { class: "sentence", type: "text", list: "mmweaver-sentences", "aria-label": "What the second person does", placeholder: "a second person (empty: none)" });
  private known = element("datalist", { id: "mmweaver-sentences" });
  private roomChoice = element("select", { "aria-label": "Room" });
  private radarChoice = element("select", { "aria-label": "Radar" });
  private boardChoice = element("select", { "aria-label": "Board" });
  private recogniserChoice = element("select", { "aria-label": "Labels in Live" });
  private recordingChoice = element("select", { "aria-label": "Recording" });
  private motionChoice = element("select", { "aria-label": "Motion" });
  private methodChoice = element("select", { "aria-label": "Method" });
  private seed = element("input", { class: "seed", type: "number", min: 0, value: 0, "aria-label": "Seed" });
  private generateButton = element("button", { class: "main" }, "Generate");
  private liveButton = element("button", { "aria-pressed": "false" }, "Live");
  private compareButton = element("button", { "aria-pressed": "false", title: "Keep this result as A and compare the next with it" }, "Compare");
  private numbersButton = element("button", { title: "The numbers of mmweaver compare", hidden: true }, "Numbers");
  private pathButton = element("button", { "aria-pressed": "false", title: "Then drag over the floor" }, "Draw path");
  private exportChoice = element("select", { "aria-label": "Export" });
  private status = element("div", { class: "status", role: "status", "aria-live": "polite" });
  private drawer = element("dialog", { "aria-label": "Details of this result" });
  private at: [number, number] | null = null;
  private path: [number, number][] | null = null;
  private kept: Sequence | null = null;
  private running: AbortController | null = null;
  private socket: WebSocket | null = null;
  private waiting: Sequence[] = [];
  private chunks: Sequence[] = [];
  private note = "";
  private corners: [number, number][] = []; // of a path by the keyboard
  private settling = 0;

  constructor() {
    const named = (label: string, control: HTMLElement) => element("label", {}, label, control);
    this.root.append(
      element("div", { class: "top" },
        element("div", { class: "line" }, element("h1", { class: "brand" }, "mmWeaver"), this.text, this.generateButton, this.liveButton, this.compareButton, this.numbersButton),
        element("div", { class: "line" }, this.second, named("room", this.roomChoice), named("radar", this.radarChoice), named("board", this.boardChoice), named("motion", this.motionChoice), named("recording", this.recordingChoice), named("labels", this.recogniserChoice), named("method", this.methodChoice), named("seed", this.seed),
          this.pathButton, element("button", { click: () => this.openDrawer() }, "Details"), this.exportChoice, this.fileButton(), this.themeButton())),
      this.status, element("div", { class: "body" }, this.player.root), this.known, this.drawer);
    this.generateButton.addEventListener("click", () => this.generate());
    for (const box of [this.text, this.second]) box.addEventListener("keydown", (event) => { if (event.key === "Enter") { if (this.socket) this.say(); else this.generate(); } });
    this.radarChoice.addEventListener("change", () => this.changeRadar());
    for (const control of [this.boardChoice, this.motionChoice, this.methodChoice, this.seed]) control.addEventListener("change", () => this.generate());
    this.roomChoice.addEventListener("change", () => this.changeRoom());
    this.liveButton.addEventListener("click", () => (this.socket ? this.stopLive() : this.startLive()));
    this.compareButton.addEventListener("click", () => this.toggleCompare());
    this.numbersButton.addEventListener("click", () => this.openNumbers());
    this.recordingChoice.addEventListener("change", () => this.openRecording());
    this.pathButton.addEventListener("click", () => { if (this.corners.length > 1) this.walkAlong(this.corners); else this.setDrawing(!this.player.scene.drawing); });
    this.exportChoice.addEventListener("change", () => this.exportAs());
    this.player.scene.onFloor = (place) => this.startAt(place);
    this.player.scene.onPath = (path) => this.walkAlong(corners(path));
    this.player.scene.onNudge = (right, ahead) => this.nudge(right, ahead);
    this.player.scene.onCorner = () => this.addCorner();
    this.takeDrops();
    addEventListener("hashchange", () => { if (this.ready && location.hash.slice(1) !== this.state()) this.restore().then(() => this.generate()); });
  }

  async start(): Promise<void> {
    try {
      const offered = await this.api.open();
      fill(this.radarChoice, offered.radars); fill(this.methodChoice, offered.methods); fill(this.boardChoice, offered.boards);
      (this.boardChoice.parentElement as HTMLElement).hidden = offered.boards.length < 2;
      fill(this.recogniserChoice, [["", "none"], ...offered.recognisers.map((name: string): [string, string] => [name, name])]); (this.recogniserChoice.parentElement as HTMLElement).hidden = !offered.recognisers.length;
      fill(this.recordingChoice, [["", "none"], ...offered.recordings.map((name: string): [string, string] => [name, name])]); (this.recordingChoice.parentElement as HTMLElement).hidden = !offered.recordings.length;
      fill(this.motionChoice, [["", "of the sentence"]]); (this.motionChoice.parentElement as HTMLElement).hidden = true; // until one is brought
      this.pathButton.hidden = !offered.paths; this.liveButton.hidden = !offered.live;
      fill(this.roomChoice, offered.rooms);
      this.exportChoice.append(element("option", { value: "" }, "Export…"), ...offered.exports.map(([value, label]: [string, string]) => element("option", { value }, label)));
      this.offer(offered.sentences);
      this.text.value = offered.text; this.seed.value = "0";
      this.api.socket("api/presence"); // when this closes, the session ends
      await this.restore();
      await this.loadRoom();
      await this.generate();
      this.ready = true;
      this.root.dataset.state = "ready";
    } catch (error) { this.fail(error); }
  }

  /** Asks for the sequence that the controls describe; an earlier question that is still open is dropped. */
  async generate(): Promise<boolean> {
    this.running?.abort();
    const asked = (this.running = new AbortController()), begun = performance.now();
    this.tell("generating…");
    try {
      if (this.ready && !this.player.room) await this.loadRoom(); // a recording hid it
      this.recordingChoice.value = "";
      const sequence = new Sequence(await this.api.packed("api/generate", this.api.post(this.asked(), asked.signal)));
      if (asked.signal.aborted) return false;
      this.lastSeconds = (performance.now() - begun) / 1000;
      this.take(sequence);
      this.remember(this.text.value);
      const at = sequence.header.meta.person?.starts_at_m ?? sequence.header.meta.people?.[0]?.person?.starts_at_m;
      if (this.at && at) this.player.scene.showStart([at[0], at[1]]);
      history.replaceState(null, "", `#${this.state()}`);
      this.tell(`${(sequence.frames * sequence.periodS).toFixed(1)} s of radar in ${this.lastSeconds.toFixed(2)} s, ${sequence.arrays.point_frame.data.length} points${this.note ? "; " + this.note : ""}`);
      return true;
    } catch (error) { if ((error as Error).name !== "AbortError") this.failMaking(error); return false; }
    finally { if (this.running === asked) this.running = null; this.note = ""; }
  }

  private take(sequence: Sequence): void {
    this.result = sequence;
    this.player.root.classList.remove("stale");
    if (this.kept) this.player.show(this.kept, sequence); else this.player.show(sequence);
    if (!this.kept) this.player.seek(this.player.frame);
  }

  private asked(): Asked {
    const text = [this.text.value, this.second.value].map((one) => one.trim()).filter((one, i) => i === 0 || one);
    return { room: this.roomChoice.value, text, radar: this.radarChoice.value, board: this.boardChoice.value, method: this.methodChoice.value, seed: Number(this.seed.value), at: this.at, path: this.path, motion: this.motionChoice.value, recogniser: this.recogniserChoice.value };
  }
  private state(): string {
    const { room, text, radar, method, seed, at, board, path } = this.asked(), pairs = new URLSearchParams({ room, radar, method, seed: String(seed) });
    for (const one of text) pairs.append("text", one);
    if (board) pairs.set("board", board);
    if (at) pairs.set("at", at.join(","));
    if (path) pairs.set("path", path.map((p) => p.join(",")).join(" "));
    return pairs.toString();
  }
  private async restore(): Promise<void> {
    const pairs = new URLSearchParams(location.hash.slice(1)), before = this.roomChoice.value;
    if (![...pairs].length) return;
    const choose = (control: HTMLSelectElement, name: string) => { const value = pairs.get(name); if (value && [...control.options].some((one) => one.value === value)) control.value = value; };
    choose(this.roomChoice, "room"); choose(this.radarChoice, "radar"); choose(this.methodChoice, "method"); choose(this.boardChoice, "board");
    const texts = pairs.getAll("text"), at = pairs.get("at")?.split(",").map(Number), path = pairs.get("path")?.split(" ").map((p) => p.split(",").map(Number) as [number, number]);
    if (texts[0]) this.text.value = texts[0];
    this.second.value = texts[1] ?? "";
    if (pairs.get("seed")) this.seed.value = pairs.get("seed")!;
    this.at = at?.length === 2 && at.every(Number.isFinite) ? [at[0], at[1]] : null;
    this.path = path ?? null;
    if (this.ready && this.roomChoice.value !== before) await this.loadRoom();
  }

  private async loadRoom(): Promise<void> {
    this.tell("reading the room…");
    this.player.setRoom(new RoomView(await this.api.packed(`api/room/${encodeURIComponent(this.roomChoice.value)}?radar=${encodeURIComponent(this.radarChoice.value)}`)));
    this.player.scene.showStart(this.at);
  }
  private async changeRoom(): Promise<void> {
    this.at = this.path = null; this.player.scene.clearPath();
    try { await this.loadRoom(); await this.generate(); } catch (error) { this.failMaking(error); }
  }

  private async changeRadar(): Promise<void> { // another range window lets people stand elsewhere
    try { await this.loadRoom(); await this.generate(); } catch (error) { this.failMaking(error); }
  }

  private startAt(place: [number, number]): void {
    const free = this.player.room?.nearestStandable(...place);
    if (!free) { this.fail(new Refused("nobody can stand in this room within the radar's range window; choose another radar or room")); return; }
    const snaps = free.distance > this.player.room!.header.cell_m * Math.SQRT1_2;
    const start = snaps ? free.place : place;
    this.at = [round(start[0]), round(start[1])]; this.path = null; this.player.scene.clearPath();
    this.note = snaps ? `no one can stand there; the nearest free place is ${this.at[0].toFixed(2)} m right and ${this.at[1].toFixed(2)} m ahead` : `starts ${this.at[0].toFixed(2)} m right and ${this.at[1].toFixed(2)} m ahead`;
    this.player.scene.showStart(this.at);
    this.generate();
  }
  private setDrawing(on: boolean): void {
    this.player.scene.drawing = on; this.corners = [];
    this.pathButton.setAttribute("aria-pressed", String(on)); this.pathButton.textContent = "Draw path";
    if (on) this.tell("drag over the floor: the person will walk along this path; or move the ring with Shift and the arrow keys, and press Enter at each corner");
  }
  private walkAlong(path: [number, number][]): void {
    this.path = path.map(([x, y]) => [round(x), round(y)]); this.at = null;
    this.player.scene.showStart(null); this.setDrawing(false);
    this.generate();
  }
  /** By the keyboard: a tenth of a metre at a time; the sequence follows when the keys rest. */
  private nudge(right: number, ahead: number): void {
    const meta = this.result?.header.meta, start = this.at ?? meta?.person?.starts_at_m ?? meta?.people?.[0]?.person?.starts_at_m ?? [0, 2];
    this.at = [round(start[0] + 0.1 * right), round(start[1] + 0.1 * ahead)];
    this.player.scene.showStart(this.at);
    clearTimeout(this.settling);
    if (!this.player.scene.drawing) this.settling = window.setTimeout(() => this.startAt(this.at!), 400);
  }
  private addCorner(): void {
    if (!this.player.scene.drawing || !this.at) return;
    this.corners.push(this.at);
    this.player.scene.showPath(this.corners);
    this.pathButton.textContent = "Walk path";
    this.tell(`${this.corners.length} corner${this.corners.length > 1 ? "s" : ""}; “Walk path” takes it`);
  }

  private toggleCompare(): void {
    if (this.kept) { this.kept = null; if (this.result) this.player.show(this.result); this.tell("one result"); }
    else if (this.result) { this.kept = this.result; this.tell("kept as A; change the sentence, seed, method, board or room, or open a recording, to make B"); }
    this.compareButton.setAttribute("aria-pressed", String(this.kept !== null)); this.numbersButton.hidden = this.kept === null;
    const id = this.kept?.header.result ?? "none"; // the server keeps it as long
    this.api.json(`api/keep/${encodeURIComponent(id)}`, { method: "POST" }).catch((error) => this.fail(error));
  }

  // live ------------------------------------------------------------------------------------------------------------
  private startLive(): void {
    const socket = (this.socket = this.api.socket("api/live"));
    this.liveButton.setAttribute("aria-pressed", "true"); this.liveButton.textContent = "Stop";
    socket.onopen = () => this.say();
    socket.onmessage = (event) => {
      if (event.data instanceof ArrayBuffer) {
        this.waiting.push(new Sequence(unpack(event.data)));
        if (this.waiting.length === 1) this.showChunk();
      } else this.fail(new Refused(JSON.parse(event.data).error));
    };
    socket.onclose = () => { if (this.socket === socket) this.stopLive(); };
  }
  /** Plays one chunk at the radar's own pace, then takes the next. */
  private showChunk(): void {
    const chunk = this.waiting[0];
    if (!chunk || !this.socket) return;
    this.chunks = [...this.chunks, chunk].slice(-LIVE_CHUNKS);
    this.live = chunk.header.live;
    const rolling = joined(this.chunks);
    this.result = rolling; this.player.show(rolling); this.player.pause();
    const first = rolling.frames - chunk.frames, begun = performance.now(), lasts = chunk.frames * chunk.periodS * 1000;
    this.tell(`live: ${this.live.frames} frames, made ${this.live.times_real_time.toFixed(1)} × faster than real time${labelText(this.live.label)}${this.live.refused ? "; " + this.live.refused : ""}`);
    const step = () => {
      if (!this.socket) return;
      const share = (performance.now() - begun) / lasts;
      this.player.seek(first + Math.min(Math.floor(share * chunk.frames), chunk.frames - 1));
      if (share < 1) { requestAnimationFrame(step); return; }
      this.waiting.shift();
      if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ ack: this.live.first_frame }));
      this.showChunk();
    };
    requestAnimationFrame(step);
  }
  private say(): void { this.socket?.send(JSON.stringify(this.asked())); this.remember(this.text.value); }
  private stopLive(): void {
    const socket = this.socket; this.socket = null; socket?.close();
    this.waiting = []; this.chunks = [];
    this.liveButton.setAttribute("aria-pressed", "false"); this.liveButton.textContent = "Live";
  }

  // out -------------------------------------------------------------------------------------------------------------
  private async exportAs(): Promise<void> {
    const kind = this.exportChoice.value, result = this.result?.header.result;
    this.exportChoice.value = "";
    if (!kind || !result) return;
    try {
      this.tell("exporting…");
      const { name, content } = await this.api.file(`api/export/${encodeURIComponent(result)}/${encodeURIComponent(kind)}`);
      download(name, content);
      this.tell("exported");
    } catch (error) { this.fail(error); }
  }

  private openDrawer(): void { if (this.result) this.show(details(this.result.header)); }
  private async openNumbers(): Promise<void> {
    const a = this.kept?.header.result, b = this.result?.header.result;
    if (!a || !b || a === b) { this.tell("make B first: change the sentence, seed, method, board or room, or open a recording"); return; }
    try {
      this.tell("comparing…");
      const found = await this.api.json(`api/compare/${encodeURIComponent(a)}/${encodeURIComponent(b)}`);
      this.tell("compared");
      this.show(numbers(found));
    } catch (error) { this.fail(error); }
  }
  private show(content: Node[]): void {
    this.drawer.replaceChildren(element("button", { click: () => this.drawer.close() }, "Close"), ...content);
    this.drawer.showModal();
  }

  // in --------------------------------------------------------------------------------------------------------------
  private fileButton(): HTMLElement {
    const opener = (label: string, more: Record<string, boolean>) => {
      const input = element("input", { type: "file", multiple: true, class: "hidden", tabindex: -1, "aria-hidden": "true", ...more });
      input.addEventListener("change", () => { this.upload(filesOfInput(input)); input.value = ""; });
      return [input, element("button", { click: () => input.click() }, label)];
    };
    return element("span", { class: "line" }, ...opener("Open files", {}), ...opener("Open folder", { webkitdirectory: true }));
  }
  private themeButton(): HTMLElement {
    return element("button", { "aria-label": "Light or dark", click: () => {
      const dark = this.root.classList.contains("dark") || (!this.root.classList.contains("light") && matchMedia("(prefers-color-scheme: dark)").matches);
      this.root.classList.toggle("dark", !dark); this.root.classList.toggle("light", dark); this.player.draw();
    } }, "◐");
  }
  private takeDrops(): void {
    this.root.addEventListener("dragover", (event) => { event.preventDefault(); this.root.classList.add("drop"); });
    this.root.addEventListener("dragleave", (event) => { if (event.relatedTarget === null) this.root.classList.remove("drop"); });
    this.root.addEventListener("drop", async (event) => {
      event.preventDefault(); this.root.classList.remove("drop");
      this.upload(await filesOfDrop(event.dataTransfer));
    });
  }
  /** Sends files; the server says what they are together: a room, a recording, a motion, or a result. */
  async upload(files: (File | Dropped)[]): Promise<void> {
    const dropped = files.map((one) => (one instanceof File ? { file: one, path: one.name } : one));
    if (!dropped.length) return;
    this.tell(`reading ${dropped.length} file${dropped.length > 1 ? "s" : ""}…`);
    try { await this.takeFound(await this.api.json("api/upload", { method: "POST", body: uploadForm(dropped, this.radarChoice.value) })); } catch (error) { this.fail(error); }
  }
  private async takeFound(found: any): Promise<void> {
    const choose = (control: HTMLSelectElement) => { control.append(element("option", { value: found.id }, found.label)); control.value = found.id; (control.parentElement as HTMLElement).hidden = false; };
    if (found.kind === "room") { choose(this.roomChoice); await this.changeRoom(); }
    else if (found.kind === "board") { choose(this.boardChoice); await this.generate(); }
    else if (found.kind === "radar") { choose(this.radarChoice); await this.changeRadar(); }
    else if (found.kind === "motion") { choose(this.motionChoice); this.path = null; this.player.scene.clearPath(); await this.generate(); }
    else this.takeRecorded(new Sequence(await this.api.packed(`api/result/${found.id}`)), found.label);
  }
  private async openRecording(): Promise<void> {
    const name = this.recordingChoice.value;
    if (!name) return;
    this.tell(`reading ${name}…`);
    try { this.takeRecorded(new Sequence(await this.api.packed(`api/recording/${encodeURIComponent(name)}`, { method: "POST" })), name); } catch (error) { this.fail(error); }
  }
  /** A recording shows no room, unless it is compared with what was made in one, or was made in the bundled one that is shown. */
  private takeRecorded(sequence: Sequence, label: string): void {
    const isHere = sequence.header.meta.inputs?.sample && this.roomChoice.value === "demo";
    if (!isHere && !this.kept) this.player.setRoom(null);
    this.take(sequence);
    this.tell(`${label}: ${sequence.frames} frames`);
  }

  // said ------------------------------------------------------------------------------------------------------------
  private tell(text: string): void { this.root.dataset.busy = String(text.endsWith("…")); this.status.className = "status"; this.status.replaceChildren(text); }
  /** The sequence that is still shown is not of what was asked: it is dimmed until the next one. */
  private failMaking(error: unknown): void {
    if (this.result) this.player.root.classList.add("stale");
    this.fail(error);
  }
  private fail(error: unknown): void {
    this.root.dataset.busy = "false";
    this.status.className = "status error";
    this.status.replaceChildren((error as Error).message);
    if (!(error instanceof Refused)) { console.error(error); return; }
    for (const way of error.waysOn) this.status.append(element("button", { click: () => this.follow(way.change) }, way.label));
  }
  private follow(change: Record<string, unknown>): void {
    if (typeof change.estimate === "string") { this.estimateDepth(change.estimate); return; }
    if (Array.isArray(change.at)) { this.at = change.at as [number, number]; this.player.scene.showStart(this.at); }
    if (change.at === null) { this.at = null; this.player.scene.showStart(null); }
    if (change.path === null) { this.path = null; this.player.scene.clearPath(); }
    if (typeof change.radar === "string") { this.radarChoice.value = change.radar; this.changeRadar(); return; }
    if (typeof change.room === "string") { this.roomChoice.value = change.room; this.changeRoom(); return; }
    if (typeof change.text === "string") this.text.value = change.text;
    this.generate();
  }
  private async estimateDepth(photo: string): Promise<void> {
    this.tell("estimating the depth…");
    try { await this.takeFound(await this.api.json(`api/depth/${encodeURIComponent(photo)}`, { method: "POST" })); } catch (error) { this.fail(error); }
  }
  private offer(sentences: string[]): void {
    const said = read(HISTORY);
    this.known.replaceChildren(...[...new Set([...said, ...sentences])].map((one) => element("option", { value: one })));
  }
  private remember(text: string): void {
    const said = [text, ...read(HISTORY).filter((one) => one !== text)].slice(0, MAX_HISTORY);
    try { localStorage.setItem(HISTORY, JSON.stringify(said)); } catch { /* private windows keep no history */ }
  }
}

/** The corners of a drawn line: places nearer than 12 cm to the line through the others are left out. */
function corners(line: [number, number][]): [number, number][] {
  if (line.length < 3) return line;
  const [[ax, ay], [bx, by]] = [line[0], line.at(-1)!], length = Math.hypot(bx - ax, by - ay);
  const away = ([x, y]: [number, number]) => (length < 1e-9 ? Math.hypot(x - ax, y - ay) : Math.abs((bx - ax) * (ay - y) - (ax - x) * (by - ay)) / length);
  let far = 1;
  line.forEach((place, k) => { if (k && k < line.length - 1 && away(place) > away(line[far])) far = k; });
  if (away(line[far]) < 0.12) return [line[0], line.at(-1)!];
  return [...corners(line.slice(0, far + 1)).slice(0, -1), ...corners(line.slice(far))];
}
const labelText = (found: { label: string; share: number; is_outside: boolean } | null) => (found ? `; recognised: ${found.label} (${Math.round(100 * found.share)} % of the votes${found.is_outside ? ", unlike anything it learned from" : ""})` : "");
const round = (value: number) => Math.round(value * 100) / 100;
const read = (key: string): string[] => { try { return JSON.parse(localStorage.getItem(key) ?? "[]"); } catch { return []; } };
function fill(control: HTMLSelectElement, options: [string, string][]): void { control.replaceChildren(...options.map(([value, label]) => element("option", { value }, label))); }
