// The panel of controls: what is asked for. It shows the state, and every change of it is an action.
import { PEOPLE } from "./body";
import { element } from "./dom";
import { filesOfInput, type Dropped } from "./drops";
import type { Action, Ask, State } from "./state";
import { isStale } from "./state";
import { HINTS, WORDS } from "./strings";

type Choice = [string, string];
export interface Offered { rooms: Choice[]; radars: Choice[]; boards: Choice[]; methods: Choice[]; recognisers: string[]; recordings: string[]; sentences: string[]; exports: Choice[]; text: string }

export class SidePanel {
  readonly root = element("aside", { class: "panel-side", "aria-label": "Controls" });
  readonly known = element("datalist", { id: "mmweaver-sentences" });
  private hint = element("p", { class: "hint" });
  private people = element("ol", { class: "people" });
  private selects: Partial<Record<keyof Ask, HTMLSelectElement>> = {};
  private seed = element("input", { class: "seed", type: "number", min: 0, max: 2147483647, value: 0, "aria-label": "Seed" });
  private generate = element("button", { class: "main" }, WORDS.generate);
  private live = element("button", { "aria-pressed": "false" }, WORDS.live);
  private draw = element("button", { "aria-pressed": "false", title: "Then drag over the floor" }, WORDS.drawPath);
  private add = element("button", {}, WORDS.addPerson);
  private range = element("input", { type: "text", "aria-label": "Range window in metres, near and far", placeholder: "the radar's own", inputmode: "decimal" });
  private recording = element("select", { "aria-label": "Recording" });
  private rows: { input: HTMLTextAreaElement; place: HTMLElement; remove: HTMLElement }[] = [];

  constructor(private dispatch: (action: Action) => void, private open: (files: Dropped[]) => void, walk: () => void) {
    const group = (title: string, isOpen: boolean, ...content: (Node | string)[]) => element("details", { open: isOpen, class: "group" }, element("summary", {}, title), ...content);
    const choose = (key: "room" | "radar" | "board" | "motion" | "method" | "recogniser", label: string, name: string) => {
      const control = (this.selects[key] = element("select", { "aria-label": name }));
      control.addEventListener("change", () => dispatch({ type: "edit", change: { [key]: control.value } }));
      return element("label", { class: "field" }, label, control);
    };
    this.seed.addEventListener("change", () => dispatch({ type: "edit", change: { seed: Math.max(0, Math.round(Number(this.seed.value)) || 0) } }));
    this.range.addEventListener("change", () => {
      const found = this.range.value.match(/\d+(\.\d+)?/g)?.map(Number);
      dispatch({ type: "edit", change: { range: found?.length === 2 ? [found[0], found[1]] : null } });
    });
    this.generate.addEventListener("click", () => dispatch({ type: "generate" }));
    this.live.addEventListener("click", () => dispatch({ type: this.live.getAttribute("aria-pressed") === "true" ? "stop" : "live" }));
    this.add.addEventListener("click", () => { dispatch({ type: "people", change: "add" }); this.rows.at(-1)?.input.focus(); });
    this.draw.addEventListener("click", walk);
    this.recording.addEventListener("change", () => { if (this.recording.value) dispatch({ type: "open", recording: this.recording.value }); });
    this.root.append(this.hint,
      element("section", { class: "group" }, element("h2", {}, WORDS.people), this.people, element("div", { class: "line" }, this.add, this.draw), element("div", { class: "line go" }, this.generate, this.live)),
      group(WORDS.room, true, choose("room", "room", "Room"), choose("motion", "motion", "Motion")),
      group(WORDS.radar, true, choose("radar", "radar", "Radar"), choose("board", "board", "Board"), element("label", { class: "field", title: "near and far range in metres, such as 0.5 to 6" }, "range (m)", this.range)),
      group(WORDS.making, true, choose("method", "method", "Method"), element("label", { class: "field" }, "seed", this.seed), choose("recogniser", "labels in Live", "Labels in Live")),
      group(WORDS.files, true, element("label", { class: "field" }, "recording", this.recording), this.fileButtons()), this.known);
  }

  fill(offered: Offered): void {
    const named = (names: string[], none: string): Choice[] => [["", none], ...names.map((name): Choice => [name, name])];
    const put = (control: HTMLSelectElement, options: Choice[], hidden = false) => { control.replaceChildren(...options.map(([value, label]) => element("option", { value }, label))); control.parentElement!.hidden = hidden; };
    put(this.selects.room!, offered.rooms); put(this.selects.radar!, offered.radars); put(this.selects.board!, offered.boards, offered.boards.length < 2); put(this.selects.method!, offered.methods);
    put(this.selects.motion!, [["", "of the sentence"]], true); // until one is brought
    put(this.selects.recogniser!, named(offered.recognisers, "none"), !offered.recognisers.length); put(this.recording, named(offered.recordings, "none"), !offered.recordings.length);
  }
  /** A room, radar, board or motion that was brought joins its list. */
  addChoice(key: "room" | "radar" | "board" | "motion", id: string, label: string): void { const control = this.selects[key]!; control.append(element("option", { value: id }, label)); control.parentElement!.hidden = false; }
  has(key: "room" | "radar" | "board" | "method", value: string): boolean { return [...this.selects[key]!.options].some((one) => one.value === value); }
  label(key: "room" | "radar" | "board" | "method", value: string): string { return [...this.selects[key]!.options].find((one) => one.value === value)?.textContent ?? value; }
  offerSentences(sentences: string[]): void { this.known.replaceChildren(...[...new Set(sentences)].map((one) => element("option", { value: one }))); }
  focusSentence(): void { this.rows[0]?.input.focus(); this.rows[0]?.input.select(); }

  update(state: State): void {
    const { ask, phase, shown } = state, isLive = phase === "live";
    this.hint.textContent = isLive ? HINTS.stream : shown ? HINTS[shown.of === "stream" ? "generated" : shown.of] : "";
    this.hint.hidden = !this.hint.textContent;
    for (const [key, control] of Object.entries(this.selects)) if (control && control.value !== String(ask[key as keyof Ask])) control.value = String(ask[key as keyof Ask]);
    if (document.activeElement !== this.range) this.range.value = ask.range ? `${ask.range[0]} to ${ask.range[1]}` : "";
    if (this.seed.value !== String(ask.seed)) this.seed.value = String(ask.seed);
    this.recording.value = shown?.of === "recording" && [...this.recording.options].some((one) => one.value === shown.name) ? shown.name : "";
    this.updatePeople(state);
    this.live.textContent = isLive ? WORDS.stop : WORDS.live; this.live.setAttribute("aria-pressed", String(isLive));
    this.generate.classList.toggle("asked-for", isStale(state)); this.generate.title = isStale(state) ? "The picture shows something else than the controls ask for" : "";
    this.draw.setAttribute("aria-pressed", String(state.drawing)); this.draw.textContent = state.corners.length > 1 ? WORDS.walkPath : WORDS.drawPath; this.draw.disabled = isLive;
    this.add.disabled = isLive || ask.people.length >= 8;
  }
  private updatePeople({ ask, phase, shown }: State): void {
    while (this.rows.length > ask.people.length) { this.rows.pop(); this.people.lastElementChild!.remove(); }
    while (this.rows.length < ask.people.length) this.addRow(this.rows.length);
    ask.people.forEach((person, i) => {
      const { input, place, remove } = this.rows[i];
      if (input.value !== person.text) { input.value = person.text; fit(input); }
      input.disabled = phase === "live" && i > 0;
      remove.hidden = ask.people.length < 2;
      place.textContent = person.path ? `along a path of ${person.path.length} corners` : person.at ? `starts ${person.at[0].toFixed(2)} m right, ${person.at[1].toFixed(2)} m ahead` : WORDS.anywhere;
      (place.nextElementSibling as HTMLElement).hidden = !person.path && !person.at;
      input.closest("li")!.classList.toggle("is-shown", shown?.ask?.people[i]?.text === person.text);
    });
  }
  private addRow(i: number): void {
    const input = element("textarea", { class: "sentence", rows: 2, "aria-label": i ? `What person ${i + 1} does` : "What the person does", spellcheck: "false", placeholder: "what this person does", enterkeyhint: "go" });
    const choices = element("select", { class: "examples", "aria-label": `Known sentences for person ${i + 1}`, title: "Known sentences" });
    choices.addEventListener("focus", () => choices.replaceChildren(element("option", { value: "" }, "⋯"), ...[...this.known.options].map((one) => element("option", { value: one.value }, one.value))));
    choices.append(element("option", { value: "" }, "⋯"));
    choices.addEventListener("change", () => { if (choices.value) { this.dispatch({ type: "type", person: i, text: choices.value }); this.dispatch({ type: "go" }); choices.value = ""; } });
    input.addEventListener("input", () => { fit(input); this.dispatch({ type: "type", person: i, text: input.value.replace(/\n/g, " ") }); });
    input.addEventListener("keydown", (event) => { if (event.key === "Enter") { event.preventDefault(); this.dispatch({ type: "go" }); } });
    const place = element("span", { class: "place" }), free = element("button", { class: "small", title: "Start anywhere free", "aria-label": "Start anywhere free", click: () => this.dispatch({ type: "edit", change: { people: this.peopleFreed(i) } }) }, "free"), remove = element("button", { class: "small", "aria-label": `${WORDS.removePerson} person ${i + 1}`, click: () => this.dispatch({ type: "people", change: "remove", person: i }) }, "✕");
    this.people.append(element("li", {}, element("span", { class: "swatch", style: `background:${PEOPLE[i % PEOPLE.length]}`, "aria-hidden": "true" }), input, choices, element("div", { class: "line" }, place, free, remove)));
    this.rows.push({ input, place, remove });
  }
  peopleNow: () => Ask["people"] = () => [];
  private peopleFreed(i: number): Ask["people"] { return this.peopleNow().map((one, k) => (k === i ? { ...one, at: null, path: null } : one)); }
  private fileButtons(): HTMLElement {
    const opener = (label: string, more: Record<string, boolean>) => {
      const input = element("input", { type: "file", multiple: true, class: "hidden", tabindex: -1, "aria-hidden": "true", ...more });
      input.addEventListener("change", () => { this.open(filesOfInput(input)); input.value = ""; });
      return [input, element("button", { click: () => input.click() }, label)];
    };
    return element("div", { class: "line" }, ...opener(WORDS.openFiles, {}), ...opener(WORDS.openFolder, { webkitdirectory: true }));
  }
}
function fit(box: HTMLTextAreaElement): void { box.style.height = "auto"; box.style.height = `${Math.max(box.scrollHeight + 2, 44)}px`; }
