// Every word of the page in one place, and what the page itself says to each error code of the server.
export const WORDS = {
  brand: "mmWeaver", people: "People", addPerson: "Add a person", removePerson: "Remove", drawPath: "Draw path", walkPath: "Walk path", anywhere: "anywhere free",
  room: "Room", radar: "Radar and board", making: "Method and seed", files: "Files", keep: "Keep", generate: "Generate", live: "Live", stop: "Stop", compare: "Compare", numbers: "Numbers", details: "Details",
  openFiles: "Open files", openFolder: "Open folder", theme: "Light or dark", fold: "Hide or show the panel", shortcuts: "Keyboard shortcuts", dismiss: "Dismiss", copy: "Copy", copied: "Copied", close: "Close",
  noRays: "Rays are computed for generated sequences; a recording does not know its propagation paths.", pickCell: "Click a cell of range-Doppler or range-azimuth to see the paths that made it.",
  drawing: "Drag over the floor; or move the ring with Shift and the arrow keys, and press Enter at each corner.",
  drop: "Drop a photo with its depth, a scan or mesh, a recording with its .cfg, a radar, a motion, or a result folder",
};
export const HINTS = {
  generated: "", stream: "Live: every control acts on the running stream; Enter adds the sentence.",
  recording: "A recording is shown. The controls below describe the next generated sequence.",
};
export const SHORTCUTS: [string, string][] = [
  ["Space", "play or pause"], ["← →", "previous or next frame"], ["Home End", "first or last frame"], ["L", "loop on or off"], ["P", "hide or show the panel"], ["T", "light or dark"], ["M", "moving cells only"],
  ["R", "rays on or off"], ["C", "compare: keep as A"], ["Enter", "in a sentence: generate, or add it in Live"], ["/", "to the first sentence"], ["0", "reset the view"],
  ["Shift + arrows", "3D view: move the start; a map: move its cursor"], ["Enter", "a map: pick the cell under the cursor; 3D view: corner of a path"], ["+ −", "a map: zoom in or out"], ["Esc", "clear the cell, close"], ["?", "these shortcuts"],
];
/** The colour and name of each kind of propagation path, by mmweaver.propagation.paths.Interaction. */
export const KINDS: [string, string][] = [
  ["rough surface", "#8a93a0"], ["reflection by faces", "#4fc3f7"], ["edge", "#c9a66b"], ["body", "#ffd54a"], ["body and a wall", "#ff8a5c"], ["wall, body, wall", "#f0569b"],
  ["body and a surface", "#b388ff"], ["body, radar, body", "#7be06b"], ["two surfaces", "#6f7f92"], ["clutter", "#5c6470"], ["two people", "#5eead4"],
];
export const STATUS: Record<string, [string, string]> = { done: ["✓", "done"], approximated: ["≈", "approximated"], "not done": ["✗", "not done"] };

/** The page's own words for a code; the server's reason is shown after them where the code does not say all. */
export const PROBLEMS: Record<string, string> = {
  sentence: "This sentence is not understood.", refused: "Live goes on without this sentence.", no_room: "The motion finds no room on this floor within the radar's range.", no_target: "The room has no such thing to go to.",
  path: "The person cannot walk along this path.", room: "This room cannot be used.", upload: "These files cannot be used.", photo_without_depth: "A photo alone is not enough: depth is missing.",
  range: "The radar does not reach this range window.", recording: "This recording cannot be read.", gone: "This result is no longer kept.", session: "This session has ended; load the page again.", busy: "The studio is busy; try again in a minute.",
  live_one_person: "Live has one person.", offline: "The studio's server does not answer; is it still running?", too_long: "The motion does not fit into the time.", input: "The studio cannot do this.",
};
export const WAYS: Record<string, string> = { remove_others: "keep the first person only", free_place: "start anywhere free" };
const OPTIONS: [RegExp, string][] = [
  [/;[^;]*--(?:landmark|classes)\b[^;]*/g, ""], [/; did you mean '.*?'\?/g, ";"], [/, listed by [`']?mmweaver motions[`']?/g, ""], [/\(?or without it --radar [^;)]*\)?/g, ""], [/:? ?(?:or )?try --(?:range|radar|path|at|seconds|frames)\b[^;)]*/g, ""], [/;? ?(?:or )?see [`']?mmweaver motions[`']?/g, ""], [/[`']?mmweaver motions[`']?( lists [^;.]*)?/g, "the list of the sentence box"],
  [/--radar/g, "radar"], [/--range/g, "range window"], [/--path/g, "the path"], [/--at/g, "the start"], [/--seconds/g, "the length"], [/--([a-z-]+)/g, "$1"], [/(?:\/[\w.+-]+){2,}\/([\w.+-]+)/g, "$1"],
];
/** A reason of the server without options of the command line and paths of its machine. */
export const inPageWords = (reason: string) => OPTIONS.reduce((text, [pattern, word]) => text.replace(pattern, word), reason).replace(/\s+/g, " ").replace(/[;,:]\s*$/, "").trim();
