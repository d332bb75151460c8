// A sequence and a room as the views read them.
import type { Packed, Tensor } from "./wire";

export interface Scale { low: number; high: number; noise: number; unit: string }

export class Sequence {
  readonly header: any;
  readonly arrays: Record<string, Tensor>;
  /** First point of each frame, and the number of all: points are in the order of frames. */
  readonly pointStart: Int32Array;
  constructor(packed: Packed, readonly version = 0, private windowS = 0) {
    this.header = packed.header; this.arrays = packed.arrays;
    this.pointStart = new Int32Array(this.frames + 1);
    const frames = packed.arrays.point_frame?.data ?? [];
    for (let i = 0; i < frames.length; i++) this.pointStart[Math.min(frames[i], this.frames - 1) + 1]++;
    for (let f = 0; f < this.frames; f++) this.pointStart[f + 1] += this.pointStart[f];
  }
  get frames(): number { return this.header.frames; }
  get periodS(): number { return this.frames > 1 ? (this.header.time_s[this.frames - 1] - this.header.time_s[0]) / (this.frames - 1) : this.header.frame_period_s; }
  get db(): Scale { return this.header.db; }
  get people(): number { return this.header.people; }
  map(name: string): Tensor { return this.arrays[name]; }
  timeS(frame: number): number { return this.header.time_s[frame] - this.header.time_s[0]; }

  /** Joint of a person at a frame, in metres. */
  joint(person: number, frame: number, joint: number): [number, number, number] {
    const { data, shape, stride } = this.arrays.joints, i = ((person * (stride ?? shape[1]) + frame) * shape[2] + joint) * 3;
    return [data[i], data[i + 1], data[i + 2]];
  }

  /** Three quarters of a Doppler bin: slower points are static echoes in a neighbouring bin, as in mmweaver.viz.figure_data. */
  get slowestMps(): number { const [low, high] = this.header.velocity_mps; return (0.75 * (high - low)) / this.arrays.range_doppler.shape[2]; }

  /** How long its time axis is: that of a stream does not grow with it. */
  get spanS(): number { return Math.max(this.windowS, this.durationS); }
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

const PER_PERSON = new Set(["joints", "capsules"]), FIXED = new Set(["radii"]);

/** The last seconds of a stream in arrays that are allocated once: a chunk is appended, and what is too old moves out. */
export class Rolling {
  version = 0;
  private frames = 0;
  private arrays: Record<string, Tensor> = {};
  private points = 0;
  private times: number[] = [];
  constructor(private most: number) {}

  push(chunk: Sequence): Sequence {
    const keep = Math.min(this.frames, this.most - chunk.frames), gone = this.frames - keep;
    for (const [name, { data, shape }] of Object.entries(chunk.arrays)) {
      if (name === "points" || name === "point_frame") continue;
      if (FIXED.has(name)) { this.arrays[name] = { data, shape }; continue; }
      const people = PER_PERSON.has(name) ? shape[0] : 1, size = data.length / people / Math.max(chunk.frames, 1);
      let own = this.arrays[name];
      if (!own || own.data.length !== people * this.most * size) own = this.arrays[name] = { data: new (data.constructor as any)(people * this.most * size), shape };
      for (let p = 0; p < people; p++) {
        const at = p * this.most * size;
        if (gone) own.data.copyWithin(at, at + gone * size, at + this.frames * size);
        own.data.set(data.subarray(p * chunk.frames * size, (p + 1) * chunk.frames * size), at + keep * size);
      }
    }
    this.takePoints(chunk, keep, gone);
    this.times = [...this.times.slice(gone), ...chunk.header.time_s];
    this.frames = keep + chunk.frames;
    this.version++;
    return this.sequence(chunk);
  }
  private takePoints(chunk: Sequence, keep: number, gone: number): void {
    const added = chunk.arrays.point_frame.data, old = this.arrays.point_frame?.data;
    let out = 0;
    if (old) while (out < this.points && old[out] < gone) out++; // points are in the order of frames
    const left = this.points - out, count = left + added.length;
    let frame = old, point = this.arrays.points?.data;
    if (!frame || frame.length < count) { frame = new Int32Array(2 * count); point = new Float32Array(10 * count); if (old) { frame.set(old.subarray(out, this.points)); point.set(this.arrays.points.data.subarray(5 * out, 5 * this.points)); } }
    else { frame.copyWithin(0, out, this.points); point!.copyWithin(0, 5 * out, 5 * this.points); }
    for (let i = 0; i < left; i++) frame[i] -= gone;
    for (let i = 0; i < added.length; i++) frame[left + i] = added[i] + keep;
    point!.set(chunk.arrays.points.data, 5 * left);
    this.points = count;
    this.arrays.point_frame = { data: frame, shape: [frame.length] }; this.arrays.points = { data: point!, shape: [frame.length, 5] };
  }
  private sequence(chunk: Sequence): Sequence {
    const arrays: Record<string, Tensor> = {};
    for (const [name, own] of Object.entries(this.arrays)) {
      const shape = [...(name === "points" || name === "point_frame" ? own.shape : chunk.arrays[name].shape)];
      if (name === "point_frame" || name === "points") { shape[0] = this.points; arrays[name] = { data: own.data.subarray(0, this.points * (name === "points" ? 5 : 1)), shape }; continue; }
      if (!FIXED.has(name)) shape[PER_PERSON.has(name) ? 1 : 0] = this.frames;
      arrays[name] = { data: own.data, shape, stride: PER_PERSON.has(name) ? this.most : undefined };
    }
    return new Sequence({ header: { ...chunk.header, frames: this.frames, time_s: this.times }, arrays }, this.version, this.most * chunk.periodS);
  }
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
