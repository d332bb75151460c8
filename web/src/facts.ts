// What a sequence's record says, next to the picture: each clause of the sentence with what became of it, and warnings.
import { element } from "./dom";
import { inPageWords, STATUS } from "./strings";
import type { Sequence } from "./sequence";

interface Clause { clause: string; status: string; how?: string; shown?: string; asked?: unknown; measured?: unknown; facts?: Record<string, unknown> }
const words = (value: unknown): string =>
  value === null || value === undefined || value === "" ? "" : Array.isArray(value) ? value.map(words).join("; ") : typeof value === "object" ? Object.entries(value).map(([name, one]) => `${name.replace(/_/g, " ")} ${words(one)}`).join(", ") : typeof value === "number" ? String(Math.round(value * 100) / 100) : String(value);

/** One chip for each clause. A clause that was not done as asked says what is shown instead. */
export function motionLine(meta: any, mark: ((kind: string) => void) | null = null): HTMLElement[] {
  const people: any[] = meta.people ?? [meta];
  return people.flatMap((one, person) => ((one.clauses ?? []) as Clause[]).map((clause) => {
    const [sign, status] = STATUS[clause.status] ?? ["•", clause.status], isDone = clause.status === "done", asked = words(clause.asked), shown = words(clause.shown) || words(clause.measured);
    const why = isDone ? "" : inPageWords(clause.how ?? "").replace(/^'.*?':\s*/, "").replace(/^is shown as /, "shown as "), kind = /no (\w+) is in the picture/.exec(clause.how ?? "")?.[1], told = [asked && `asked ${asked}`, why || (shown && `shown: ${shown}`)].filter(Boolean).join("; ");
    return element("li", { class: `clause ${clause.status.replace(" ", "-")}`, title: [status, asked && `asked: ${asked}`, shown && `shown: ${shown}`, words(clause.facts)].filter(Boolean).join("\n") },
      element("span", { class: "sign", "aria-hidden": "true" }, sign), element("span", { class: "hidden" }, `${status}: `), people.length > 1 ? `${person + 1}: ${clause.clause}` : clause.clause, ...(isDone || !told ? [] : [element("em", {}, ` ${told}`)]), ...(kind && mark ? [element("button", { class: "small", click: () => mark(kind) }, `show where the ${kind} is`)] : []));
  }));
}

/** Warnings of a recording, damaged and missing frames, and how the scale lies to the noise. */
export function warnings(sequence: Sequence): HTMLElement[] {
  const meta = sequence.header.meta, lost = meta.packets?.lost_bytes ? [`${meta.packets.lost} packets were lost; their samples are zero`] : [];
  const damaged = meta.damaged_frames ?? meta.missing_frames ?? meta.lost_frames, count = Array.isArray(damaged) ? damaged.length : Number(damaged ?? 0);
  const said = [...(meta.warnings ?? []), ...lost, ...(count ? [`${count} frames are damaged or missing`] : []), ...(meta.kind === "log" ? meta.assumed ?? [] : [])];
  if (sequence.header.frames_in_all > sequence.frames) said.push(`${sequence.frames} of ${sequence.header.frames_in_all} frames are shown`);
  return [...new Set<string>(said)].map((one) => element("li", { class: "warning" }, element("span", { class: "sign", "aria-hidden": "true" }, "⚠"), inPageWords(one)));
}
export const noiseChip = (sequence: Sequence) => (sequence.db.unit === "dBm" ? [element("li", { class: "noise" }, `noise ${sequence.db.noise.toFixed(0)} dBm a cell`.replace("-", "−"))] : []);

/** What tells two results apart: the sentences, or else radar, method, seed or board. */
export function differences(a: Sequence, b: Sequence): [string, string] {
  const of = ({ header: { meta, radar } }: Sequence) => [[meta.text ?? ""].flat().join(" | "), radar, meta.method ?? "recorded", `seed ${meta.seed ?? "none"}`, meta.board?.name ?? ""].map(String);
  const [one, two] = [of(a), of(b)], told = one.map((value, k) => (value !== two[k] ? k : -1)).filter((k) => k >= 0), shown = told.length ? told : [0];
  return [shown.map((k) => one[k]).join(", "), shown.map((k) => two[k]).join(", ")];
}
