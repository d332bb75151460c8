// A sequence and a room as the views read them.
import type { Packed, Tensor } from "./wire";

export interface Scale { low: number; high: number; noise: number; unit: string }

export class Sequence {
  readonly header: any;
  readonly arrays: Record<string, Tensor>;
  constructor(packed: Packed) { this.header = packed.header; this.arrays = packed.arrays; }
  get frames(): number { return this.header.frames; }
  get periodS(): number { return this.frames > 1 ? (this.header.time_s[this.frames - 1] - this.header.time_s[0]) / (this.frames - 1) : this.header.frame_period_s; }
  get db(): Scale { return this.header.db; }
  get people(): number { return this.header.people; }
  map(name: string): Tensor { return this.arrays[name]; }
  timeS(frame: number): number { return this.header.time_s[frame] - this.header.time_s[0]; }

  /** Joint of a person at a frame, in metres. */
  joint(person: number, frame: number, joint: number): [number, number, number] {
    const { data, shape } = this.arrays.joints, i = ((person * shape[1] + frame) * shape[2] + joint) * 3;
    return [data[i], data[i + 1], data[i + 2]];
  }

  get durationS(): number { return this.frames * this.periodS; }

  /** The frame nearest to a time, the first or last where it lies outside. */
  frameAt(timeS: number): number {
    const guess = Math.round(timeS / this.periodS);
    return Math.max(0, Math.min(this.frames - 1, guess));
  }

  /** What each person's joints span at a frame: ranges in metres, radial velocities in m/s, azimuths in radians. */
  bodyCells(frame: number): { range: [number, number]; velocity: [number, number]; azimuth: [number, number] }[] {
    const before = Math.max(frame - 1, 0), after = Math.min(frame + 1, this.frames - 1), apartS = Math.max(this.timeS(after) - this.timeS(before), 1e-6);
    return Array.from({ length: this.people }, (_, person) => {
      const range: number[] = [], velocity: number[] = [], azimuth: number[] = [];
      for (let j = 0; j < this.arrays.joints.shape[2]; j++) {
        const place = this.joint(person, frame, j);
        range.push(Math.hypot(...place));
        azimuth.push(Math.atan2(place[0], place[1]));
        velocity.push((Math.hypot(...this.joint(person, after, j)) - Math.hypot(...this.joint(person, before, j))) / apartS);
      }
      const span = (values: number[]): [number, number] => [Math.min(...values), Math.max(...values)];
      return { range: span(range), velocity: span(velocity), azimuth: span(azimuth) };
    });
  }
}

/** One power scale for two sequences, and what to add to each one's decibels. Without a common unit both count from their noise. */
export function commonScale(a: Sequence, b: Sequence | null): { low: number; high: number; unit: string; addA: number; addB: number } {
  if (!b) return { ...a.db, addA: 0, addB: 0 };
  const same = a.db.unit === b.db.unit && a.db.unit === "dBm", addA = same ? 0 : -a.db.noise, addB = same ? 0 : -b.db.noise;
  return { low: Math.min(a.db.low + addA, b.db.low + addB), high: Math.max(a.db.high + addA, b.db.high + addB), unit: same ? "dBm" : "dB over noise", addA, addB };
}

/** Several chunks of a stream as one sequence; frames and points count on, and the latest header holds. */
export function joined(chunks: Sequence[]): Sequence {
  const last = chunks[chunks.length - 1], arrays: Record<string, Tensor> = {}, starts: number[] = [];
  let frames = 0;
  for (const chunk of chunks) { starts.push(frames); frames += chunk.frames; }
  for (const name of Object.keys(last.arrays)) {
    const parts = chunks.map((chunk) => chunk.arrays[name]);
    if (name === "radii") { arrays[name] = parts[parts.length - 1]; continue; }
    const perPerson = name === "joints" || name === "capsules", axis = perPerson ? 1 : 0;
    const shape = [...parts[0].shape]; shape[axis] = parts.reduce((sum, part) => sum + part.shape[axis], 0);
    const data = new (parts[0].data.constructor as any)(shape.reduce((a, b) => a * b, 1));
    const people = perPerson ? shape[0] : 1;
    let at = 0;
    for (let person = 0; person < people; person++)
      parts.forEach((part, k) => {
        const size = part.data.length / people, piece = part.data.subarray(person * size, (person + 1) * size);
        data.set(piece, at);
        if (name === "point_frame") for (let i = at; i < at + size; i++) data[i] += starts[k];
        at += size;
      });
    arrays[name] = { data, shape };
  }
  return new Sequence({ header: { ...last.header, frames, time_s: chunks.flatMap((chunk) => chunk.header.time_s) }, arrays });
}

export class RoomView {
  readonly header: any;
  readonly arrays: Record<string, Tensor>;
  constructor(packed: Packed) { this.header = packed.header; this.arrays = packed.arrays; }

  /** The place nearest to (x, y) where a person can stand, and its distance in metres; null where there is none. */
  nearestStandable(x: number, y: number): { place: [number, number]; distance: number } | null {
    const cells = this.arrays.free_floor.data, standable = this.arrays.standable.data;
    let best = Infinity, at = -1;
    for (let i = 0; i < cells.length; i += 2) {
      if (!standable[i / 2]) continue;
      const d = Math.hypot(cells[i] - x, cells[i + 1] - y);
      if (d < best) { best = d; at = i; }
    }
    return at < 0 ? null : { place: [cells[at], cells[at + 1]], distance: best };
  }
}
