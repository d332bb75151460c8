// The room in 3D: photo points, surfaces, free floor, people, radar points, the radar's field of view, and floor clicks.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { velocityColour } from "./colours";
import { element, themeColour } from "./dom";
import type { RoomView, Sequence } from "./sequence";

const PEOPLE = ["#e8b04a", "#57c26b", "#d678c8", "#6fa8ff", "#e07a5f", "#9d8bf0", "#3fc4ad", "#c9c9c9"];
const CLICK_PX = 5;
type Layer = "room" | "planes" | "free" | "points" | "trail";

function dot(): THREE.Texture {
  const canvas = element("canvas", { width: 32, height: 32 }), g = canvas.getContext("2d")!;
  g.fillStyle = "#fff"; g.beginPath(); g.arc(16, 16, 15, 0, 7); g.fill();
  return new THREE.CanvasTexture(canvas);
}

function shade(): THREE.Texture {
  const canvas = element("canvas", { width: 64, height: 64 }), g = canvas.getContext("2d")!;
  const blur = g.createRadialGradient(32, 32, 2, 32, 32, 31);
  blur.addColorStop(0, "rgba(0,0,0,0.55)"); blur.addColorStop(1, "rgba(0,0,0,0)");
  g.fillStyle = blur; g.fillRect(0, 0, 64, 64);
  return new THREE.CanvasTexture(canvas);
}

/** The parts of one person's body: cones between two balls, placed anew in each frame. */
class Body {
  readonly group = new THREE.Group();
  private parts: { start: THREE.Mesh; end: THREE.Mesh; shaft: THREE.Mesh }[] = [];
  private shadow: THREE.Mesh;
  constructor(private sequence: Sequence, private person: number, colour: string, private floorZ: number, isPale: boolean) {
    const material = new THREE.MeshStandardMaterial({ color: colour, roughness: 0.75, transparent: isPale, opacity: isPale ? 0.45 : 1 });
    const radii = sequence.arrays.radii, count = radii.shape[1];
    for (let k = 0; k < count; k++) {
      const [r0, r1] = [radii.data[(person * count + k) * 2], radii.data[(person * count + k) * 2 + 1]];
      const ball = (r: number) => new THREE.Mesh(new THREE.SphereGeometry(r, 14, 10), material);
      const part = { start: ball(r0), end: ball(r1), shaft: new THREE.Mesh(new THREE.CylinderGeometry(r1, r0, 1, 14, 1, true), material) };
      this.parts.push(part); this.group.add(part.start, part.end, part.shaft);
    }
    this.shadow = new THREE.Mesh(new THREE.PlaneGeometry(0.9, 0.9), new THREE.MeshBasicMaterial({ map: shade(), transparent: true, depthWrite: false }));
    this.group.add(this.shadow);
  }
  show(frame: number, share: number): void {
    const { data, shape } = this.sequence.arrays.capsules, [, frames, count] = shape;
    const next = Math.min(frame + 1, frames - 1), a = new THREE.Vector3(), b = new THREE.Vector3(), along = new THREE.Vector3();
    const at = (f: number, k: number, c: number) => data[((this.person * frames + f) * count + k) * 6 + c];
    const mix = (k: number, c: number) => at(frame, k, c) * (1 - share) + at(next, k, c) * share;
    this.parts.forEach((part, k) => {
      a.set(mix(k, 0), mix(k, 1), mix(k, 2)); b.set(mix(k, 3), mix(k, 4), mix(k, 5));
      part.start.position.copy(a); part.end.position.copy(b);
      along.subVectors(b, a);
      part.shaft.position.addVectors(a, b).multiplyScalar(0.5);
      part.shaft.scale.set(1, Math.max(along.length(), 1e-4), 1);
      part.shaft.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.lengthSq() > 1e-12 ? along.normalize() : new THREE.Vector3(0, 1, 0));
    });
    const pelvis = this.sequence.joint(this.person, frame, 0);
    this.shadow.position.set(pelvis[0], pelvis[1], this.floorZ + 0.015);
  }
  dispose(): void { this.group.traverse((o) => { if (o instanceof THREE.Mesh) o.geometry.dispose(); }); }
}

export class SceneView {
  readonly root = element("div", { class: "scene" });
  onFloor: (place: [number, number]) => void = () => {};
  onPath: (path: [number, number][]) => void = () => {};
  onBody: (inside: boolean) => void = () => {};
  onNudge: (right: number, ahead: number) => void = () => {};
  onCorner: () => void = () => {};
  drawing = false;
  private renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  private scene = new THREE.Scene();
  private camera = new THREE.PerspectiveCamera(50, 1, 0.05, 80);
  private orbit: OrbitControls;
  private layers: Record<string, THREE.Object3D> = {};
  private bodies: Body[] = [];
  private otherBodies: Body[] = []; // of B, pale
  private sequence: Sequence | null = null;
  private other: Sequence | null = null;
  private floorZ = -1;
  private ghost: THREE.Mesh;
  private drawn: [number, number][] = [];
  private hidden = new Set<Layer>(["planes"]);
  private pending = false;

  constructor() {
    const canvas = this.renderer.domElement;
    canvas.setAttribute("role", "img"); canvas.setAttribute("tabindex", "0");
    canvas.setAttribute("aria-label", "The room in 3D with people and radar points. Click the floor, or press Shift and an arrow key, to choose where the person starts; drag to turn, scroll to zoom.");
    this.root.append(canvas);
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.addEventListener("change", () => this.render());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x556070, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.8); sun.position.set(-1, -2, 4); this.scene.add(sun);
    this.ghost = new THREE.Mesh(new THREE.RingGeometry(0.16, 0.21, 40), new THREE.MeshBasicMaterial({ color: "#00a7d6", side: THREE.DoubleSide }));
    this.ghost.visible = false; this.scene.add(this.ghost);
    this.home();
    let down: [number, number] | null = null, dragged = false;
    canvas.addEventListener("pointerdown", (event) => {
      down = [event.clientX, event.clientY];
      dragged = !this.drawing && (this.hitsBody(event) || this.hitsRing(event));
      if (this.drawing || dragged) this.orbit.enabled = false;
      if (this.drawing) this.drawn = [];
    });
    canvas.addEventListener("pointermove", (event) => {
      const place = down && dragged ? this.floorAt(event) : null;
      if (this.drawing && down) this.drawTo(event);
      else if (place) this.showStart(place);
      else if (!event.buttons) { const inside = this.hitsBody(event); canvas.style.cursor = inside || this.hitsRing(event) ? "grab" : ""; this.onBody(inside); }
    });
    canvas.addEventListener("pointerup", (event) => {
      const start = down; down = null; this.orbit.enabled = true;
      if (!start) return;
      if (this.drawing && this.drawn.length > 1) { this.onPath(this.drawn); return; }
      if (!dragged && Math.hypot(event.clientX - start[0], event.clientY - start[1]) > CLICK_PX) return;
      const place = this.floorAt(event);
      if (place) this.onFloor(place);
    });
    canvas.addEventListener("pointerleave", () => this.onBody(false));
    canvas.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (event.key === "Home") this.home();
      else if (event.key === "Enter") this.onCorner();
      else if (by && event.shiftKey) this.onNudge(by[0], by[1]);
      else return;
      event.preventDefault(); event.stopPropagation();
    });
    new ResizeObserver(() => this.resize()).observe(this.root);
  }

  /** The camera's usual place: behind and above the radar, looking into the room. */
  home(): void {
    this.camera.position.set(1.6, -2.6, 1.7); this.orbit.target.set(0, 2.0, -0.5); this.orbit.update();
  }

  show(layer: Layer, visible: boolean): void {
    if (visible) this.hidden.delete(layer); else this.hidden.add(layer);
    const object = this.layers[layer];
    if (object) object.visible = visible;
    this.render();
  }

  setRoom(room: RoomView | null): void {
    for (const name of ["room", "planes", "free"]) this.drop(name);
    if (!room) { this.render(); return; }
    this.floorZ = room.header.floor_z_m;
    const mm = room.arrays.room_points.data, place = new Float32Array(mm.length), colour = new Float32Array(mm.length), rgb = room.arrays.room_colours.data;
    for (let i = 0; i < mm.length; i++) { place[i] = mm[i] / 1000; colour[i] = (rgb[i] / 255) ** 2.2; }
    this.put("room", cloud(place, colour, 0.042));
    const cells = room.arrays.free_floor.data, floor = new Float32Array((cells.length / 2) * 3);
    for (let i = 0; i < cells.length / 2; i++) floor.set([cells[2 * i], cells[2 * i + 1], this.floorZ + 0.01], 3 * i);
    const free = cloud(floor, null, 0.03); (free.material as THREE.PointsMaterial).color.set("#2fbf7b"); (free.material as THREE.PointsMaterial).transparent = true; (free.material as THREE.PointsMaterial).opacity = 0.35;
    this.put("free", free);
    const planes = new THREE.Group();
    for (const plane of room.header.planes) {
      const c = plane.corners_m.flat(), shape = new THREE.BufferGeometry();
      shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(c), 3)); shape.setIndex([0, 1, 2, 0, 2, 3]); shape.computeVertexNormals();
      const colour = plane.reflects ? "#e4572e" : plane.kind === "floor" ? "#6b7683" : "#4a90c2";
      planes.add(new THREE.Mesh(shape, new THREE.MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false })));
      const edge = new THREE.BufferGeometry(); edge.setAttribute("position", new THREE.BufferAttribute(new Float32Array([...c, ...c.slice(0, 3)]), 3));
      planes.add(new THREE.Line(edge, new THREE.LineBasicMaterial({ color: colour })));
    }
    this.put("planes", planes);
    this.render();
  }

  /** The people and the radar's view of a sequence; those of `other` are pale. */
  setSequence(sequence: Sequence, other: Sequence | null = null): void {
    this.sequence = sequence; this.other = other;
    for (const body of [...this.bodies, ...this.otherBodies]) { this.scene.remove(body.group); body.dispose(); }
    const bodiesOf = (one: Sequence, isPale: boolean) => Array.from({ length: one.people }, (_, p) => new Body(one, p, PEOPLE[(p + (isPale ? 3 : 0)) % PEOPLE.length], this.floorZ, isPale));
    this.bodies = bodiesOf(sequence, false); this.otherBodies = other ? bodiesOf(other, true) : [];
    for (const body of [...this.bodies, ...this.otherBodies]) this.scene.add(body.group);
    const trail = new THREE.Group();
    for (const [one, shift] of other ? ([[sequence, 0], [other, 3]] as const) : ([[sequence, 0]] as const))
      for (let p = 0; p < one.people; p++) {
        const path = new Float32Array(one.frames * 3);
        for (let f = 0; f < one.frames; f++) { const [x, y] = one.joint(p, f, 0); path.set([x, y, this.floorZ + 0.03], 3 * f); }
        trail.add(line(path, PEOPLE[(p + shift) % PEOPLE.length]));
      }
    this.put("trail", trail);
    const [near, far] = sequence.header.range_m, [left, right] = sequence.header.azimuth_rad, view = new THREE.Group();
    const arcOf = (r: number) => arcPoints(r, left, right, this.floorZ + 0.02);
    for (const r of [Math.max(near, 0), far]) view.add(line(arcOf(r), "#00a7d6"));
    for (const t of [left, right]) view.add(line(new Float32Array([Math.max(near, 0) * Math.sin(t), Math.max(near, 0) * Math.cos(t), this.floorZ + 0.02, far * Math.sin(t), far * Math.cos(t), this.floorZ + 0.02]), "#00a7d6"));
    const radar = new THREE.Mesh(new THREE.BoxGeometry(0.1, 0.03, 0.1), new THREE.MeshStandardMaterial({ color: "#c22" })); view.add(radar);
    this.put("view", view);
  }

  /** Frame `frame`, `share` of the way to the next, and the same of B, whose points are squares. */
  showFrame(frame: number, share: number, frameB = 0, shareB = 0): void {
    if (!this.sequence) return;
    for (const body of this.bodies) body.show(frame, share);
    for (const body of this.otherBodies) body.show(frameB, shareB);
    const points = new THREE.Group();
    points.add(detections(this.sequence, frame, true));
    if (this.other) points.add(detections(this.other, frameB, false));
    this.put("points", points);
    this.render();
  }

  /** The ring where the person will start; null hides it. */
  showStart(place: [number, number] | null): void {
    this.ghost.visible = place !== null;
    if (place) this.ghost.position.set(place[0], place[1], this.floorZ + 0.04);
    this.render();
  }

  /** The arc of a range and the ray of an azimuth, as far as they are given. */
  showCell(rangeM: number | null, azimuthRad: number | null): void {
    this.drop("cell");
    if (this.sequence && (rangeM !== null || azimuthRad !== null)) {
      const cell = new THREE.Group(), [left, right] = this.sequence.header.azimuth_rad, far = this.sequence.header.range_m[1];
      if (rangeM !== null) cell.add(line(arcPoints(rangeM, left, right, this.floorZ + 0.05), "#ffffff"), line(arcPoints(rangeM, left, right, 0), "#ffffff"));
      if (azimuthRad !== null) cell.add(line(new Float32Array([0, 0, 0, far * Math.sin(azimuthRad), far * Math.cos(azimuthRad), 0]), "#ffffff"));
      cell.userData = { rangeM, azimuthRad };
      this.put("cell", cell);
    }
    this.render();
  }

  /** For tests and screen readers: the range of the arc that is drawn, measured on its geometry; null without one. */
  arcRangeM(): number | null {
    const arc = this.layers.cell?.children[0] as THREE.Line | undefined;
    if (!arc || this.layers.cell.userData.rangeM === null) return null;
    const p = arc.geometry.getAttribute("position");
    return Math.hypot(p.getX(0), p.getY(0));
  }

  /** Where a place of the floor appears, in pixels of the page. */
  toPage(x: number, y: number): [number, number] {
    const p = new THREE.Vector3(x, y, this.floorZ).project(this.camera), box = this.renderer.domElement.getBoundingClientRect();
    return [box.left + ((p.x + 1) / 2) * box.width, box.top + ((1 - p.y) / 2) * box.height];
  }

  /** Share of the canvas that is not background. */
  paintedShare(): number {
    this.draw();
    const g = this.renderer.getContext(), w = g.drawingBufferWidth, h = g.drawingBufferHeight, pixels = new Uint8Array(w * h * 4);
    g.readPixels(0, 0, w, h, g.RGBA, g.UNSIGNED_BYTE, pixels);
    let painted = 0;
    for (let i = 0; i < pixels.length; i += 4) if (Math.abs(pixels[i] - pixels[0]) + Math.abs(pixels[i + 1] - pixels[1]) + Math.abs(pixels[i + 2] - pixels[2]) > 24) painted++;
    return painted / (w * h);
  }

  picture(): string { this.draw(); return this.renderer.domElement.toDataURL("image/png"); }

  dispose(): void { this.renderer.dispose(); this.renderer.forceContextLoss(); }

  private ray(event: PointerEvent): THREE.Raycaster {
    const box = this.renderer.domElement.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), this.camera);
    return caster;
  }
  private floorAt(event: PointerEvent): [number, number] | null {
    const hit = new THREE.Vector3();
    return this.ray(event).ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), -this.floorZ), hit) ? [hit.x, hit.y] : null;
  }
  private hitsBody(event: PointerEvent): boolean {
    return this.bodies.length > 0 && this.ray(event).intersectObjects(this.bodies.map((body) => body.group), true).length > 0;
  }
  private hitsRing(event: PointerEvent): boolean {
    const place = this.ghost.visible ? this.floorAt(event) : null;
    return place !== null && Math.hypot(place[0] - this.ghost.position.x, place[1] - this.ghost.position.y) < 0.25;
  }
  private drawTo(event: PointerEvent): void {
    const place = this.floorAt(event), last = this.drawn.at(-1);
    if (!place || (last && Math.hypot(place[0] - last[0], place[1] - last[1]) < 0.15)) return;
    this.drawn.push(place);
    this.showPath(this.drawn);
  }
  /** A line over the floor. */
  showPath(path: [number, number][]): void {
    this.put("path", line(new Float32Array(path.flatMap(([x, y]) => [x, y, this.floorZ + 0.05])), "#00a7d6"));
    this.render();
  }
  clearPath(): void { this.drop("path"); this.render(); }
  private put(name: string, object: THREE.Object3D): void {
    this.drop(name);
    object.visible = !this.hidden.has(name as Layer);
    this.layers[name] = object; this.scene.add(object);
  }
  private drop(name: string): void {
    const old = this.layers[name];
    if (!old) return;
    this.scene.remove(old); delete this.layers[name];
    old.traverse((o: any) => { o.geometry?.dispose(); o.material?.dispose(); });
  }
  private resize(): void {
    const { clientWidth: w, clientHeight: h } = this.root;
    if (!w || !h) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2)); this.renderer.setSize(w, h);
    this.camera.aspect = w / h; this.camera.updateProjectionMatrix();
    this.draw(); // at once: setting the size has cleared the canvas
  }
  private render(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(); });
  }
  private draw(): void {
    this.scene.background = new THREE.Color(themeColour(this.root, "--backdrop") || "#14161a");
    this.renderer.render(this.scene, this.camera);
  }
}

const DOT = dot();

function cloud(place: Float32Array, colour: Float32Array | null, size: number): THREE.Points {
  const shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(place, 3));
  if (colour) shape.setAttribute("color", new THREE.BufferAttribute(colour, 3));
  const points = new THREE.Points(shape, new THREE.PointsMaterial({ size, vertexColors: colour !== null }));
  points.frustumCulled = false;
  return points;
}

/** The detections of a frame, coloured by radial velocity. */
function detections(sequence: Sequence, frame: number, isRound: boolean): THREE.Points {
  const { data } = sequence.arrays.points, frames = sequence.arrays.point_frame.data, place: number[] = [], colour: number[] = [];
  for (let k = 0; k < frames.length; k++)
    if (frames[k] === frame) { place.push(data[5 * k], data[5 * k + 1], data[5 * k + 2]); colour.push(...velocityColour(data[5 * k + 3], 1.5)); }
  const points = cloud(new Float32Array(place), new Float32Array(colour), isRound ? 0.09 : 0.07), material = points.material as THREE.PointsMaterial;
  if (isRound) { material.map = DOT; material.alphaTest = 0.5; }
  material.depthTest = false; points.renderOrder = 1; // echoes lie on and in the body that would hide them
  return points;
}

function line(place: Float32Array, colour: string): THREE.Line {
  const shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(place, 3));
  const made = new THREE.Line(shape, new THREE.LineBasicMaterial({ color: colour }));
  made.frustumCulled = false;
  return made;
}

function arcPoints(r: number, left: number, right: number, z: number): Float32Array {
  const steps = 48, out = new Float32Array((steps + 1) * 3);
  for (let k = 0; k <= steps; k++) { const t = left + ((right - left) * k) / steps; out.set([r * Math.sin(t), r * Math.cos(t), z], 3 * k); }
  return out;
}
