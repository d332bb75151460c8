// What the studio knows, and nothing else: the page shows this state, and `reduce` alone changes it.
//
//     starting --boot--> making --made--> idle         a person's edits:   idle --> making (or stale, for typed words)
//        making --failed--> idle, with a problem       Live:               idle --> live --> idle
//        opening --opened--> idle                      an edit in Live:    live --> live, by a stream of its own
//        any --new job--> making | opening | live      an answer to any job but the last one changes nothing
//
// `ask` is what the controls say, `shown` what the picture is of; both are on the page, and `isStale` where they differ.

export type Place = [number, number];
export interface Person { text: string; at: Place | null; path: Place[] | null }
export interface Ask { room: string; people: Person[]; radar: string; board: string; method: string; seed: number; motion: string; recogniser: string; range: Place | null; landmarks: [string, Place][] }
export interface Way { label: string; change: Partial<Ask> & { at?: Place | null; path?: null; text?: string; landmark?: string; estimate?: string } }
export interface Problem { code: string; reason: string; ways: Way[]; of: "making" | "live" | "opening" | "other" }
export interface Shown { id: string; of: "generated" | "recording" | "stream"; ask: Ask | null; name: string; radar: string; facts: string }
export interface LiveFacts { frames: number; times: number; text: string; refused: string; ways: Way[]; label: { label: string; share: number; is_outside: boolean } | null }
export type Phase = "starting" | "idle" | "making" | "opening" | "live";
export interface State {
  phase: Phase; job: number; ask: Ask; room: string; // whose room the scene shows, "" for none
  shown: Shown | null; kept: Shown | null; problem: Problem | null; live: LiveFacts | null; note: string; drawing: boolean; corners: Place[];
  marking: string; // the kind of landmark that the next click on the floor places, or ""
}

export type Action =
  | { type: "edit"; change: Partial<Ask>; note?: string } // anything but words, at once
  | { type: "type"; person: number; text: string } // words, until "go"
  | { type: "people"; change: "add" | "remove"; person?: number }
  | { type: "go" } | { type: "generate" } | { type: "live" } | { type: "stop" } | { type: "dismiss" }
  | { type: "restore"; ask: Ask }
  | { type: "place"; at: Place; note: string } | { type: "walk"; path: Place[] } | { type: "draw"; on: boolean } | { type: "mark"; kind: string } | { type: "corner"; at: Place }
  | { type: "open"; recording: string } | { type: "open-result"; id: string; name: string }
  | { type: "keep"; on: boolean } | { type: "note"; text: string } | { type: "problem"; problem: Problem }
  // answers of the server
  | { type: "room"; job: number; room: string } | { type: "made"; job: number; shown: Shown } | { type: "opened"; job: number; shown: Shown; hasRoom: boolean }
  | { type: "chunk"; job: number; live: LiveFacts; radar: string } | { type: "failed"; job: number; problem: Problem } | { type: "closed"; job: number };

export type Effect =
  | { do: "make" | "stream"; job: number; ask: Ask; needsRoom: boolean } | { do: "say"; ask: Ask } | { do: "end-stream" }
  | { do: "open"; job: number; recording: string; result: string; name: string } | { do: "keep"; id: string } | { do: "address"; ask: Ask };

export const nobody = (): Person => ({ text: "", at: null, path: null });
export const roomKey = (ask: Ask) => `${ask.room} ${ask.radar} ${ask.range ?? ""}`; // another radar observes other places of the floor
export const same = (a: unknown, b: unknown) => JSON.stringify(a) === JSON.stringify(b);
const spoken = (ask: Ask) => ({ ...ask, people: ask.people.filter((one, i) => i === 0 || one.text.trim()), recogniser: "" });

/** Whether the controls ask for something else than the picture shows. */
export const isStale = ({ shown, ask, phase }: State) => shown !== null && phase === "idle" && (shown.ask === null || !same(spoken(shown.ask), spoken(ask)));

export function start(ask: Ask): State {
  return { phase: "starting", job: 0, ask, room: "", shown: null, kept: null, problem: null, live: null, note: "", drawing: false, corners: [], marking: "" };
}

type Step = [State, Effect[]];
const ends = (state: State): Effect[] => (state.phase === "live" ? [{ do: "end-stream" }] : []);

function make(state: State): Step {
  const job = state.job + 1;
  return [{ ...state, phase: "making", job, problem: null, live: null, drawing: false, corners: [] },
    [...ends(state), { do: "make", job, ask: state.ask, needsRoom: state.room !== roomKey(state.ask) }]];
}
function stream(state: State): Step {
  if (state.ask.people.filter((one) => one.text.trim()).length > 1) return [{ ...state, problem: { code: "live_one_person", reason: "", of: "live", ways: [{ label: "remove_others", change: { people: state.ask.people.slice(0, 1) } }] } }, []];
  const job = state.job + 1;
  return [{ ...state, phase: "live", job, problem: null, live: null, note: "", drawing: false, corners: [] },
    [...ends(state), { do: "stream", job, ask: state.ask, needsRoom: state.room !== roomKey(state.ask) }]];
}
const again = (state: State): Step => (state.phase === "live" ? stream(state) : make(state)); // an edit acts on what runs
const first = (state: State, change: Partial<Person>): Ask => ({ ...state.ask, people: state.ask.people.map((one, i) => (i ? one : { ...one, ...change })) });

/** The next state, and what is to be done for it. */
export function reduce(state: State, action: Action): Step {
  if ("job" in action && action.job !== state.job) return [state, []];
  switch (action.type) {
    case "edit": {
      const ask = { ...state.ask, ...action.change }, isElsewhere = action.change.room !== undefined && action.change.room !== state.ask.room;
      if (isElsewhere) ask.people = ask.people.map((one) => ({ ...one, at: null, path: null })), ask.landmarks = []; // places of another floor
      if (action.change.motion) ask.people = ask.people.map((one) => ({ ...one, path: null }));
      return again({ ...state, ask, note: action.note ?? "" });
    }
    case "type": return [{ ...state, ask: { ...state.ask, people: state.ask.people.map((one, i) => (i === action.person ? { ...one, text: action.text } : one)) } }, []];
    case "people": {
      if (action.change === "add") return [{ ...state, ask: { ...state.ask, people: [...state.ask.people, nobody()] } }, []];
      const people = state.ask.people.filter((_, i) => i !== action.person), was = state.ask.people[action.person ?? 0];
      const next = { ...state, ask: { ...state.ask, people: people.length ? people : [nobody()] } };
      return was?.text.trim() && state.phase !== "live" ? make(next) : [next, []];
    }
    case "go": return state.phase === "live" ? [{ ...state, problem: null }, [{ do: "say", ask: state.ask }]] : make(state);
    case "generate": return make(state);
    case "live": return stream(state);
    case "stop": return [{ ...state, phase: state.phase === "live" ? "idle" : state.phase, job: state.phase === "live" ? state.job + 1 : state.job, live: null }, ends(state)];
    case "dismiss": return [{ ...state, problem: null }, []];
    case "restore": return same(action.ask, state.ask) ? [state, []] : make({ ...state, ask: action.ask, note: "" });
    case "place":
      if (state.marking) return again({ ...state, ask: { ...state.ask, landmarks: [...state.ask.landmarks.filter(([kind]) => kind !== state.marking), [state.marking, action.at]] }, marking: "", note: `the ${state.marking} is there` });
      return again({ ...state, ask: first(state, { at: action.at, path: null }), note: action.note });
    case "walk": return make({ ...state, ask: first(state, { path: action.path, at: null }), note: "" });
    case "draw": return [{ ...state, drawing: action.on, corners: [] }, []];
    case "mark": return [{ ...state, marking: action.kind, drawing: false, corners: [] }, []];
    case "corner": return [{ ...state, corners: [...state.corners, action.at] }, []];
    case "open": case "open-result": {
      const job = state.job + 1, [recording, result, name] = action.type === "open" ? [action.recording, "", action.recording] : ["", action.id, action.name];
      return [{ ...state, phase: "opening", job, problem: null, live: null, note: "" }, [...ends(state), { do: "open", job, recording, result, name }]];
    }
    case "keep": {
      const kept = action.on && state.shown?.of !== "stream" ? state.shown : null;
      return [{ ...state, kept }, [{ do: "keep", id: kept?.id ?? "none" }]];
    }
    case "note": return [{ ...state, note: action.text }, []];
    case "problem": return [{ ...state, problem: action.problem }, []];
    case "room": return state.room === action.room ? [state, []] : [{ ...state, room: action.room, shown: null }, []]; // people of another room leave with it
    case "made": return [{ ...state, phase: "idle", shown: action.shown, problem: null }, [{ do: "address", ask: action.shown.ask! }]];
    case "opened": return [{ ...state, phase: "idle", shown: action.shown, problem: null, room: action.hasRoom || state.kept ? state.room : "" }, []];
    case "chunk": {
      const shown: Shown = { id: "", of: "stream", ask: { ...state.ask, people: [{ ...state.ask.people[0], text: action.live.text }] }, name: action.live.text, radar: action.radar, facts: "" };
      const problem: Problem | null = action.live.refused ? { code: "refused", reason: action.live.refused, of: "live", ways: action.live.ways } : state.problem; // stays until the next sentence
      return [{ ...state, live: action.live, shown, problem }, []];
    }
    case "failed": return [{ ...state, phase: "idle", live: null, problem: action.problem }, ends(state)];
    case "closed": return [{ ...state, phase: "idle", live: null, job: state.job + 1 }, []];
  }
}
