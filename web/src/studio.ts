// The studio: carries out what the state asks for, and shows it. What happens is decided in state.ts.
import { Api, Refused } from "./api";
import { element } from "./dom";
import { details, numbers, shortcuts } from "./drawer";
import { filesOfDrop, uploadForm, type Dropped } from "./drops";
import { Player } from "./player";
import { raysOf } from "./rays";
import { Rolling, RoomView, Sequence } from "./sequence";
import { remembered } from "./settings";
import { SidePanel, type Offered } from "./side_panel";
import { isStale, nobody, reduce, roomKey, start, type Action, type Ask, type Effect, type LiveFacts, type Place, type Problem, type Shown, type State, type Way } from "./state";
import { inPageWords, PROBLEMS, WAYS, WORDS } from "./strings";
import { unpack } from "./wire";
import { exportChoices, saveOf } from "./exports";

const LIVE_FRAMES = 120; // of the rolling picture
const MAX_HISTORY = 30;
const EMPTY: Ask = { room: "", people: [nobody()], radar: "", board: "", method: "", seed: 0, motion: "", recogniser: "", range: null, landmarks: [] };

export class Studio {
  readonly root = element("main", { class: "mmweaver studio" });
  readonly player = new Player();
  readonly reduce = reduce; // for tests
  state: State = start(EMPTY);
  lastSeconds = 0;
  readonly api = new Api();
  private settings = remembered("mmweaver.studio", { theme: "auto", isFolded: false, sentences: [] as string[] });
  private panel: SidePanel;
  private title = element("span", { class: "shown-title" });
  private status = element("div", { class: "status", role: "status", "aria-live": "polite" });
  private problem = element("div", { class: "problem", role: "alert", hidden: true });
  private compareButton = element("button", { "aria-pressed": "false", title: "Keep this result as A and compare the next with it (C)" }, WORDS.compare);
  private numbersButton = element("button", { title: "The numbers of mmweaver compare", hidden: true }, WORDS.numbers);
  private exportChoice = element("select", { "aria-label": "Export" });
  private foldButton = element("button", { class: "round", "aria-label": WORDS.fold, title: `${WORDS.fold} (P)`, "aria-expanded": "true" }, "☰");
  private drawer = element("dialog", { "aria-label": "Details" });
  private sequences = new WeakMap<Shown, Sequence>();
  private rooms = new Map<string, RoomView>();
  private drawn: { shown: Shown | null; kept: Shown | null; room: string } = { shown: null, kept: null, room: "" };
  private running: AbortController | null = null;
  private socket: WebSocket | null = null;
  private rolling = new Rolling(LIVE_FRAMES);
  private waiting: Sequence[] = [];
  private sentences: string[] = [];
  private settling = 0;
  private isFirst = true;

  constructor() {
    this.panel = new SidePanel((action) => this.dispatch(action), (files) => void this.upload(files), () => this.toggleDrawing());
    this.panel.peopleNow = () => this.state.ask.people;
    const top = element("header", { class: "top" }, this.foldButton, element("h1", { class: "brand" }, WORDS.brand), this.title, this.status, element("span", { class: "spring" }), this.compareButton, this.numbersButton,
      element("button", { click: () => { const result = this.result; if (result) this.open(details(result.header)); } }, WORDS.details), this.exportChoice,
      element("button", { class: "round", "aria-label": WORDS.shortcuts, title: `${WORDS.shortcuts} (?)`, click: () => this.open(shortcuts()) }, "?"), element("button", { class: "round", "aria-label": WORDS.theme, title: `${WORDS.theme} (T)`, click: () => this.switchTheme() }, "◐"));
    this.root.append(top, this.problem, element("div", { class: "body" }, this.panel.root, this.player.root), this.drawer);
    this.foldButton.addEventListener("click", () => this.fold(!this.settings.value.isFolded));
    this.compareButton.addEventListener("click", () => this.dispatch({ type: "keep", on: this.state.kept === null }));
    this.numbersButton.addEventListener("click", () => void this.openNumbers());
    this.exportChoice.addEventListener("change", () => void this.exportAs());
    const { scene } = this.player;
    scene.onFloor = (place) => this.startAt(place);
    scene.onPath = (path) => this.dispatch({ type: "walk", path: corners(path).map(([x, y]) => [round(x), round(y)]) });
    scene.onNudge = (right, ahead) => this.nudge(right, ahead);
    scene.onCorner = () => { const { ask, drawing } = this.state, at = ask.people[0].at; if (drawing && at) this.dispatch({ type: "corner", at }); };
    this.player.tracer = async (sequence, frame) => raysOf(await this.api.packed(`api/rays/${encodeURIComponent(sequence.header.result)}?frame=${frame}`));
    this.player.mark = (kind) => this.dispatch({ type: "mark", kind });
    this.takeDrops();
    addEventListener("popstate", () => { const ask = this.askOfAddress(); if (ask && this.root.dataset.state === "ready") this.dispatch({ type: "restore", ask }); });
    document.addEventListener("keydown", (event) => this.key(event));
    this.fold(this.settings.value.isFolded); this.applyTheme();
  }

  get result(): Sequence | null { return this.state.shown ? this.sequences.get(this.state.shown) ?? null : null; }
  get live(): LiveFacts | null { return this.state.live; }

  async start(): Promise<void> {
    try {
      const offered: Offered = await this.api.open();
      this.panel.fill(offered);
      this.exportChoice.append(...exportChoices(offered.exports));
      this.sentences = offered.sentences; this.panel.offerSentences([...this.settings.value.sentences, ...offered.sentences]);
      this.api.socket("api/presence"); // when this closes, the session ends
      this.state = start({ ...EMPTY, room: offered.rooms[0][0], radar: offered.radars[0][0], board: offered.boards[0]?.[0] ?? "", method: offered.methods[0][0], people: [{ ...nobody(), text: offered.text }] });
      this.state = start(this.askOfAddress() ?? this.state.ask);
      this.dispatch({ type: "generate" });
    } catch (error) { this.fail(error, "other"); }
  }

  /** The one way in which anything changes. */
  dispatch(action: Action): void {
    const [state, effects] = this.reduce(this.state, action);
    this.state = state;
    if (action.type !== "room") this.show(); // a room is shown with what came of it
    for (const effect of effects) this.run(effect);
  }

  // what is to be done ----------------------------------------------------------------------------------------------
  private run(effect: Effect): void {
    if (effect.do === "make") void this.make(effect.job, effect.ask, effect.needsRoom);
    else if (effect.do === "stream") void this.stream(effect.job, effect.ask, effect.needsRoom);
    else if (effect.do === "say") { this.socket?.send(JSON.stringify(body(effect.ask))); this.remember(effect.ask); }
    else if (effect.do === "end-stream") { const { socket } = this; this.socket = null; this.waiting = []; socket?.close(); }
    else if (effect.do === "open") void this.openRecorded(effect);
    else if (effect.do === "keep") this.api.json(`api/keep/${encodeURIComponent(effect.id)}`, { method: "POST" }).catch((error) => this.fail(error, "other"));
    else if (effect.do === "address") { const hash = `#${address(effect.ask)}`; if (hash !== location.hash) history[this.isFirst ? "replaceState" : "pushState"](null, "", hash); this.isFirst = false; }
  }

  private async make(job: number, ask: Ask, needsRoom: boolean): Promise<void> {
    this.running?.abort();
    const { signal } = (this.running = new AbortController()), begun = performance.now();
    try {
      if (needsRoom) await this.loadRoom(ask, signal);
      const sequence = new Sequence(await this.api.packed("api/generate", this.api.post(body(ask), signal)));
      this.lastSeconds = (performance.now() - begun) / 1000;
      this.dispatch({ type: "room", job, room: roomKey(ask) });
      this.dispatch({ type: "made", job, shown: this.shownAs(sequence, "generated", ask, `${(sequence.frames * sequence.periodS).toFixed(1)} s of radar in ${this.lastSeconds.toFixed(2)} s, ${sequence.arrays.point_frame.data.length} points`) });
      this.remember(ask);
      if (this.root.dataset.state !== "ready") { this.root.dataset.state = "ready"; if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.player.play(); }
    } catch (error) {
      if ((error as Error).name === "AbortError") return;
      if (this.rooms.has(roomKey(ask))) this.dispatch({ type: "room", job, room: roomKey(ask) });
      this.dispatch({ type: "failed", job, problem: problemOf(error, "making") });
      this.root.dataset.state = "ready";
    }
  }
  private shownAs(sequence: Sequence, of: Shown["of"], ask: Ask | null, facts: string, name = ""): Shown {
    const shown: Shown = { id: sequence.header.result ?? "", of, ask, name: name || [sequence.header.meta.text ?? ""].flat().join(" | "), radar: sequence.header.radar, facts };
    this.sequences.set(shown, sequence);
    return shown;
  }
  private async loadRoom(ask: Ask, signal?: AbortSignal): Promise<void> {
    if (this.rooms.has(roomKey(ask))) return;
    this.rooms.set(roomKey(ask), new RoomView(await this.api.packed(`api/room/${encodeURIComponent(ask.room)}?radar=${encodeURIComponent(ask.radar)}&range=${ask.range ?? ""}`, { signal })));
    while (this.rooms.size > 4) this.rooms.delete(this.rooms.keys().next().value!);
  }
  private async openRecorded({ job, recording, result, name }: { job: number; recording: string; result: string; name: string }): Promise<void> {
    try {
      const sequence = new Sequence(await (recording ? this.api.packed(`api/recording/${encodeURIComponent(recording)}`, { method: "POST" }) : this.api.packed(`api/result/${result}`)));
      const isHere = Boolean(sequence.header.meta.inputs?.sample) && this.state.room.startsWith("demo ");
      this.dispatch({ type: "opened", job, shown: this.shownAs(sequence, "recording", null, `${sequence.frames} frames`, name), hasRoom: isHere });
    } catch (error) { this.dispatch({ type: "failed", job, problem: problemOf(error, "opening") }); }
  }

  // live ------------------------------------------------------------------------------------------------------------
  private async stream(job: number, ask: Ask, needsRoom: boolean): Promise<void> {
    this.running?.abort();
    this.rolling = new Rolling(LIVE_FRAMES); this.waiting = [];
    try {
      if (needsRoom) { await this.loadRoom(ask); this.dispatch({ type: "room", job, room: roomKey(ask) }); this.show(); }
    } catch (error) { this.dispatch({ type: "failed", job, problem: problemOf(error, "live") }); return; }
    if (job !== this.state.job) return;
    const socket = (this.socket = this.api.socket("api/live"));
    socket.onopen = () => { socket.send(JSON.stringify(body(ask))); this.remember(ask); };
    socket.onmessage = (event) => {
      if (typeof event.data === "string") { const told = JSON.parse(event.data); this.dispatch({ type: "failed", job, problem: problemOf(new Refused(told.error, told.ways_on, told.code), "live") }); return; }
      this.waiting.push(new Sequence(unpack(event.data)));
      if (this.waiting.length === 1) this.showChunk(job, socket);
    };
    socket.onclose = () => { if (this.socket === socket) { this.socket = null; this.dispatch({ type: "closed", job }); } };
  }
  /** Plays one chunk at the radar's own pace, then takes the next. */
  private showChunk(job: number, socket: WebSocket): void {
    const chunk = this.waiting[0];
    if (!chunk || this.socket !== socket) return;
    const sequence = this.rolling.push(chunk), live: LiveFacts = { ...chunk.header.live, ways: nearest(chunk.header.live.refused ?? ""), times: chunk.header.live.times_real_time }, first = sequence.frames - chunk.frames;
    this.player.pause(); this.player.frame = first;
    this.dispatch({ type: "chunk", job, live, radar: sequence.header.radar });
    this.sequences.set(this.state.shown!, sequence); this.show();
    const begun = performance.now(), lasts = chunk.frames * chunk.periodS * 1000;
    let at = first;
    const step = () => {
      if (this.socket !== socket) return;
      const share = (performance.now() - begun) / lasts, frame = first + Math.min(Math.floor(share * chunk.frames), chunk.frames - 1);
      if (frame !== at) { at = frame; this.player.seek(frame); }
      if (share < 1) { setTimeout(step, Math.max(4, ((frame - first + 1) / chunk.frames) * lasts - (performance.now() - begun))); return; }
      this.waiting.shift();
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ ack: chunk.header.live.first_frame }));
      this.showChunk(job, socket);
    };
    step();
  }

  // what is shown ---------------------------------------------------------------------------------------------------
  private show(): void {
    const { state, player, drawn } = this, { shown, kept, phase, live, problem } = state, a = kept && this.sequences.get(kept), b = shown && this.sequences.get(shown);
    this.panel.update(state);
    this.root.dataset.busy = String(phase === "making" || phase === "opening" || phase === "starting"); this.root.dataset.phase = phase;
    if (drawn.room !== state.room) { player.setRoom(this.rooms.get(state.room) ?? null); drawn.room = state.room; drawn.shown = null; }
    if (!b) { if (!shown) player.clear(); } else if (drawn.shown !== shown || drawn.kept !== kept) { if (a && shown !== kept) player.show(a, b); else player.show(b); }
    if (b || !shown) { drawn.shown = shown; drawn.kept = kept; }
    player.root.classList.toggle("stale", problem !== null && problem.of === "making" && isStale(state));
    const person = state.ask.people[0];
    player.scene.drawing = state.drawing;
    player.scene.showStart(person.at); player.scene.showPath(state.drawing ? state.corners : person.path);
    this.compareButton.setAttribute("aria-pressed", String(kept !== null)); this.numbersButton.hidden = kept === null; this.exportChoice.disabled = !shown?.id;
    this.title.textContent = shown ? `${shown.name}` : ""; this.title.title = shown?.ask ? `Shown: ${shown.name}; ${this.panel.label("room", shown.ask.room)}, ${shown.radar}, ${this.panel.label("board", shown.ask.board)}, ${this.panel.label("method", shown.ask.method)}, seed ${shown.ask.seed}` : `Shown: ${shown?.name ?? "nothing"}`;
    this.status.textContent = state.marking ? `click the floor where the ${state.marking} is` : state.drawing ? (state.corners.length ? `${state.corners.length} corner${state.corners.length > 1 ? "s" : ""}; “${WORDS.walkPath}” takes it` : WORDS.drawing) : phase === "making" ? "generating…" : phase === "opening" ? "reading…" : phase === "starting" ? "starting…"
      : live ? `live: ${live.frames} frames, made ${live.times.toFixed(1)} × faster than real time${labelText(live.label)}` : phase === "live" ? "live: starting…" : [shown?.facts, state.note].filter(Boolean).join("; ");
    this.showProblem(problem);
  }
  private showProblem(problem: Problem | null): void {
    this.problem.hidden = problem === null;
    if (!problem) { this.problem.replaceChildren(); return; }
    const reason = inPageWords(problem.reason), own = PROBLEMS[problem.code] ?? PROBLEMS.input;
    this.problem.dataset.code = problem.code;
    this.problem.replaceChildren(element("strong", {}, own), element("span", {}, reason ? ` ${reason}` : ""), ...problem.ways.map((way) => element("button", { click: () => this.follow(way) }, WAYS[way.label] ?? way.label)), element("button", { class: "small", "aria-label": WORDS.dismiss, click: () => this.dispatch({ type: "dismiss" }) }, "✕"));
  }
  private fail(error: unknown, of: Problem["of"]): void { if (!(error instanceof Refused)) console.error(error); this.dispatch({ type: "problem", problem: problemOf(error, of) }); }

  // what a person does ----------------------------------------------------------------------------------------------
  follow({ change }: Pick<Way, "change">): void {
    if (change.estimate) { void this.take(this.api.json(`api/depth/${encodeURIComponent(change.estimate)}`, { method: "POST" })); return; }
    if (change.landmark) { this.dispatch({ type: "mark", kind: change.landmark }); return; }
    if (change.text) { this.dispatch({ type: "type", person: 0, text: change.text }); this.dispatch({ type: "go" }); return; }
    const { at, path, text, estimate: _, landmark: __, ...more } = change, people = more.people ?? this.state.ask.people.map((one, i) => (i ? one : { ...one, ...(at !== undefined ? { at, path: null } : {}), ...(path === null ? { path: null } : {}), ...(text ? { text } : {}) }));
    const wasLive = this.state.problem?.code === "live_one_person";
    this.dispatch({ type: "edit", change: { ...more, people } });
    if (wasLive) this.dispatch({ type: "live" });
  }
  startAt(place: Place): void {
    if (this.state.marking) { this.dispatch({ type: "place", at: place.map(round) as Place, note: "" }); return; }
    const free = this.player.room?.nearestStandable(...place);
    if (!free) { this.dispatch({ type: "problem", problem: { code: "no_room", reason: "Nobody can stand here within the radar's range; choose another radar or room.", ways: [], of: "other" } }); return; }
    const snaps = free.distance > this.player.room!.header.cell_m * Math.SQRT1_2, at = (snaps ? free.place : place).map(round) as Place, words = `${at[0].toFixed(2)} m right and ${at[1].toFixed(2)} m ahead`;
    this.dispatch({ type: "place", at, note: snaps ? `no one can stand there; the nearest free place is ${words}` : `starts ${words}` });
  }
  private toggleDrawing(): void { const { corners: path, drawing } = this.state; if (path.length > 1) this.dispatch({ type: "walk", path }); else this.dispatch({ type: "draw", on: !drawing }); }
  /** By the keyboard: a tenth of a metre at a time; the sequence follows when the keys rest. */
  private nudge(right: number, ahead: number): void {
    const meta = this.result?.header.meta, [x, y] = this.state.ask.people[0].at ?? meta?.person?.starts_at_m ?? meta?.people?.[0]?.person?.starts_at_m ?? [0, 2], at: Place = [round(x + 0.1 * right), round(y + 0.1 * ahead)];
    clearTimeout(this.settling);
    this.state = { ...this.state, ask: { ...this.state.ask, people: this.state.ask.people.map((one, i) => (i ? one : { ...one, at })) } }; this.show();
    if (!this.state.drawing) this.settling = window.setTimeout(() => this.startAt(at), 400);
  }
  /** Sends files; the server says what they are together: a room, a recording, a motion, or a result. */
  async upload(files: (File | Dropped)[]): Promise<void> {
    const dropped = files.map((one) => (one instanceof File ? { file: one, path: one.name } : one));
    if (!dropped.length) return;
    this.status.textContent = `reading ${dropped.length} file${dropped.length > 1 ? "s" : ""}…`; this.root.dataset.busy = "true";
    await this.take(this.api.json("api/upload", { method: "POST", body: uploadForm(dropped, this.state.ask.radar) }));
  }
  private async take(answer: Promise<any>): Promise<void> {
    try {
      const found = await answer, kind = found.kind as "room" | "radar" | "board" | "motion" | "result";
      if (kind === "result") { this.dispatch({ type: "open-result", id: found.id, name: found.label }); return; }
      this.panel.addChoice(kind, found.id, found.label);
      this.dispatch({ type: "edit", change: { [kind]: found.id }, note: `${found.label} joined the list` });
    } catch (error) { this.fail(error, "opening"); }
  }
  private takeDrops(): void {
    this.root.dataset.drop = WORDS.drop;
    this.root.addEventListener("dragover", (event) => { event.preventDefault(); this.root.classList.add("drop"); });
    this.root.addEventListener("dragleave", (event) => { if (event.relatedTarget === null) this.root.classList.remove("drop"); });
    this.root.addEventListener("drop", async (event) => { event.preventDefault(); this.root.classList.remove("drop"); await this.upload(await filesOfDrop(event.dataTransfer)); });
  }
  private async exportAs(): Promise<void> {
    const kind = this.exportChoice.value, id = this.state.shown?.id;
    this.exportChoice.value = "";
    if (!kind || !id) return;
    this.dispatch({ type: "note", text: "exporting…" });
    try { await saveOf(kind, this.player, (what) => this.api.file(`api/export/${encodeURIComponent(id)}/${encodeURIComponent(what)}`)); this.dispatch({ type: "note", text: "exported" }); } catch (error) { this.fail(error, "other"); }
  }
  private async openNumbers(): Promise<void> {
    const a = this.state.kept?.id, b = this.state.shown?.id;
    if (!a || !b || a === b) { this.dispatch({ type: "note", text: "make B first: change the sentence, seed, method, board or room, or open a recording" }); return; }
    try { this.open(numbers(await this.api.json(`api/compare/${encodeURIComponent(a)}/${encodeURIComponent(b)}`))); } catch (error) { this.fail(error, "other"); }
  }
  private open(content: Node[]): void { this.drawer.replaceChildren(element("button", { click: () => this.drawer.close() }, WORDS.close), ...content); this.drawer.showModal(); }
  private fold(isFolded: boolean): void { this.settings.set({ isFolded }); this.root.classList.toggle("folded", isFolded); this.foldButton.setAttribute("aria-expanded", String(!isFolded)); }
  private applyTheme(): void { for (const theme of ["light", "dark"]) this.root.classList.toggle(theme, this.settings.value.theme === theme); this.player.themeChanged(); }
  private switchTheme(): void {
    const { theme } = this.settings.value, isDark = theme === "dark" || (theme === "auto" && matchMedia("(prefers-color-scheme: dark)").matches);
    this.settings.set({ theme: isDark ? "light" : "dark" }); this.applyTheme();
  }
  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (this.drawer.open || event.defaultPrevented || target.closest(".player")) return; // the player has its own
    if (target.matches("textarea, select, input:not([type=checkbox])")) { if (event.key === "Escape") target.blur(); return; }
    this.act(event);
  }
  private act(event: KeyboardEvent): void {
    const actions: Record<string, () => void> = { "?": () => this.open(shortcuts()), "/": () => { this.fold(false); this.panel.focusSentence(); }, p: () => this.fold(!this.settings.value.isFolded), t: () => this.switchTheme(), c: () => this.compareButton.click() };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (actions[event.key]) { actions[event.key](); event.preventDefault(); } else this.player.key(event);
  }
  private remember(ask: Ask): void {
    const said = [ask.people[0].text.trim(), ...this.settings.value.sentences.filter((one) => one !== ask.people[0].text.trim())].filter(Boolean).slice(0, MAX_HISTORY);
    this.settings.set({ sentences: said }); this.panel.offerSentences([...said, ...this.sentences]);
  }
  private askOfAddress(): Ask | null {
    const pairs = new URLSearchParams(location.hash.slice(1)), { ask } = this.state;
    if (![...pairs].length) return null;
    const choice = (key: "room" | "radar" | "method" | "board") => { const value = pairs.get(key); return value && this.panel.has(key, value) ? value : ask[key]; };
    const numbers = (text: string) => text.split(",").map(Number) as Place, isPlace = (place: Place) => place.length === 2 && place.every(Number.isFinite), at = pairs.get("at"), path = pairs.get("path")?.split(" ").map(numbers), texts = pairs.getAll("text");
    const people = (texts.length ? texts : [ask.people[0].text]).map((text, i) => ({ text, at: !i && at && isPlace(numbers(at)) ? numbers(at) : null, path: !i && path?.every(isPlace) ? path : null }));
    const range = numbers(pairs.get("range") ?? ""), landmarks = pairs.getAll("landmark").map((one): [string, Place] => [one.split(",")[0], numbers(one.split(",").slice(1).join(","))]).filter(([, place]) => isPlace(place));
    return { ...ask, range: isPlace(range) ? range : null, landmarks, room: choice("room"), radar: choice("radar"), method: choice("method"), board: choice("board"), seed: Math.max(0, Math.round(Number(pairs.get("seed"))) || 0), people };
  }
}

/** The JSON of a request. */
export function body({ people, landmarks, ...ask }: Ask): Record<string, unknown> {
  return { ...ask, landmark: landmarks.map(([kind, place]) => `${kind}=${place}`), text: people.map((one) => one.text.trim()).filter((text, i) => i === 0 || text), at: people[0].at, path: people[0].path };
}
function address(ask: Ask): string {
  const pairs = new URLSearchParams({ room: ask.room, radar: ask.radar, method: ask.method, seed: String(ask.seed) }), [{ at, path }] = ask.people;
  for (const { text } of ask.people) if (text.trim()) pairs.append("text", text.trim());
  if (ask.board) pairs.set("board", ask.board);
  if (ask.range) pairs.set("range", ask.range.join(","));
  for (const [kind, place] of ask.landmarks) pairs.append("landmark", `${kind},${place}`);
  if (at) pairs.set("at", at.join(","));
  if (path) pairs.set("path", path.map((p) => p.join(",")).join(" "));
  return pairs.toString();
}
function problemOf(error: unknown, of: Problem["of"]): Problem {
  if (error instanceof Refused) return { code: error.code, reason: error.message, ways: [...(error.waysOn as Way[]), ...nearest(error.message)], of };
  console.error(error);
  return { code: "input", reason: (error as Error).message, ways: [], of };
}
/** The known sentence that the server found nearest, as a button. */
const nearest = (reason: string): Way[] => [...reason.matchAll(/did you mean '(.+?)'\?/g)].map(([, text]) => ({ label: `“${text}”`, change: { text } }));
/** The corners of a drawn line: everything between them lies within 12 cm of it (Douglas and Peucker). */
function corners(line: Place[]): Place[] {
  const [[ax, ay], [bx, by]] = [line[0], line.at(-1)!], length = Math.hypot(bx - ax, by - ay);
  const away = ([x, y]: Place) => (length ? Math.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length : Math.hypot(x - ax, y - ay));
  let far = 0;
  line.forEach((place, k) => { if (k && k < line.length - 1 && away(place) > away(line[far])) far = k; });
  if (away(line[far]) < 0.12) return [line[0], line.at(-1)!];
  return [...corners(line.slice(0, far + 1)).slice(0, -1), ...corners(line.slice(far))];
}
const labelText = (found: LiveFacts["label"]) => (found ? `; recognised: ${found.label} (${Math.round(100 * found.share)} % of the votes${found.is_outside ? ", unlike anything it learned from" : ""})` : "");
const round = (value: number) => Math.round(value * 100) / 100;
