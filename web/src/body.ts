// One person's body: a tapered capsule for each part, all in one mesh whose vertices follow the frames.
import * as THREE from "three";
import type { Sequence } from "./sequence";

export const PEOPLE = ["#e8b04a", "#57c26b", "#d678c8", "#6fa8ff", "#e07a5f", "#9d8bf0", "#3fc4ad", "#c9c9c9"];
export const LIVING_PALE = 3; // colours of B are those three further on
const AROUND = 12, BANDS = 4; // meridians, and rings of each end

/** A unit capsule: ring angle from -90 to 90 degrees at either end, and the angle around. */
function template(): { up: Float32Array; out: Float32Array; end: Uint8Array; around: Float32Array; index: number[] } {
  const up: number[] = [], out: number[] = [], end: number[] = [], around: number[] = [], index: number[] = [];
  for (const e of [0, 1])
    for (let b = 0; b <= BANDS; b++)
      for (let a = 0; a < AROUND; a++) {
        const angle = ((e ? b : b - BANDS) / BANDS) * (Math.PI / 2);
        up.push(Math.sin(angle)); out.push(Math.cos(angle)); end.push(e); around.push((a / AROUND) * 2 * Math.PI);
      }
  for (let ring = 0; ring < 2 * BANDS + 1; ring++)
    for (let a = 0; a < AROUND; a++) {
      const p = ring * AROUND + a, q = ring * AROUND + ((a + 1) % AROUND);
      index.push(p, q, p + AROUND, q, q + AROUND, p + AROUND);
    }
  return { up: new Float32Array(up), out: new Float32Array(out), end: new Uint8Array(end), around: new Float32Array(around), index };
}
const UNIT = template();

function shade(): THREE.Texture {
  const canvas = document.createElement("canvas"), g = canvas.getContext("2d")!;
  canvas.width = canvas.height = 64;
  const blur = g.createRadialGradient(32, 32, 2, 32, 32, 31);
  blur.addColorStop(0, "rgba(0,0,0,0.55)"); blur.addColorStop(1, "rgba(0,0,0,0)");
  g.fillStyle = blur; g.fillRect(0, 0, 64, 64);
  return new THREE.CanvasTexture(canvas);
}

export class Body {
  readonly group = new THREE.Group();
  private mesh: THREE.Mesh;
  private shadow: THREE.Mesh;
  private at: number[] = []; // frame and share that the vertices are of
  constructor(private sequence: Sequence, private person: number, colour: string, private floorZ: number, isPale: boolean) {
    const count = sequence.arrays.radii.shape[1], vertices = UNIT.up.length, shape = new THREE.BufferGeometry(), index: number[] = [];
    for (let k = 0; k < count; k++) for (const i of UNIT.index) index.push(k * vertices + i);
    for (const name of ["position", "normal"]) shape.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * count * vertices), 3).setUsage(THREE.DynamicDrawUsage));
    shape.setIndex(index);
    this.mesh = new THREE.Mesh(shape, new THREE.MeshStandardMaterial({ color: colour, roughness: 0.75, transparent: isPale, opacity: isPale ? 0.5 : 1 }));
    this.mesh.frustumCulled = false;
    this.shadow = new THREE.Mesh(new THREE.PlaneGeometry(0.9, 0.9), new THREE.MeshBasicMaterial({ map: shade(), transparent: true, depthWrite: false }));
    this.group.add(this.mesh, this.shadow);
  }
  /** Follows a sequence that went on, of the same people. */
  follow(sequence: Sequence): void { this.sequence = sequence; this.at = []; }

  show(frame: number, share: number): void {
    if (this.at[0] === frame && this.at[1] === share) return;
    this.at = [frame, share];
    const { capsules, radii } = this.sequence.arrays, [, frames, count] = capsules.shape, kept = capsules.stride ?? frames, next = Math.min(frame + 1, frames - 1);
    const from = (this.person * kept + frame) * count * 6, to = (this.person * kept + next) * count * 6, vertices = UNIT.up.length;
    const position = this.mesh.geometry.getAttribute("position"), normal = this.mesh.geometry.getAttribute("normal"), p = position.array as Float32Array, n = normal.array as Float32Array;
    const w = new THREE.Vector3(), u = new THREE.Vector3(), v = new THREE.Vector3(), start = new Float32Array(6);
    for (let k = 0; k < count; k++) {
      for (let c = 0; c < 6; c++) start[c] = capsules.data[from + 6 * k + c] * (1 - share) + capsules.data[to + 6 * k + c] * share;
      w.set(start[3] - start[0], start[4] - start[1], start[5] - start[2]);
      if (w.lengthSq() < 1e-12) w.set(0, 0, 1);
      w.normalize(); u.set(Math.abs(w.z) < 0.9 ? 0 : 1, 0, Math.abs(w.z) < 0.9 ? 1 : 0).cross(w).normalize(); v.crossVectors(w, u);
      for (let i = 0; i < vertices; i++) {
        const e = UNIT.end[i], r = radii.data[(this.person * count + k) * 2 + e], ca = Math.cos(UNIT.around[i]) * UNIT.out[i], sa = Math.sin(UNIT.around[i]) * UNIT.out[i], o = 3 * (k * vertices + i);
        const x = u.x * ca + v.x * sa + w.x * UNIT.up[i], y = u.y * ca + v.y * sa + w.y * UNIT.up[i], z = u.z * ca + v.z * sa + w.z * UNIT.up[i];
        n[o] = x; n[o + 1] = y; n[o + 2] = z;
        p[o] = start[3 * e] + r * x; p[o + 1] = start[3 * e + 1] + r * y; p[o + 2] = start[3 * e + 2] + r * z;
      }
    }
    position.needsUpdate = normal.needsUpdate = true;
    this.mesh.geometry.boundingSphere = null;
    const pelvis = this.sequence.joint(this.person, frame, 0);
    this.shadow.position.set(pelvis[0], pelvis[1], this.floorZ + 0.015);
  }
  dispose(): void { this.group.traverse((o) => { if (o instanceof THREE.Mesh) { o.geometry.dispose(); o.material.map?.dispose(); o.material.dispose(); } }); }
}
