// The room in 3D: its textured surface, the people, radar points, propagation paths, and the radar with its field of view.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Body, LIVING_PALE, PEOPLE } from "./body";
import { velocityColour } from "./colours";
import { element, themeColour } from "./dom";
import { StillPicture } from "./still_picture";
import { KINDS } from "./strings";
import { strongest, type Rays } from "./rays";
import type { RoomView, Sequence } from "./sequence";

const CLICK_PX = 5;
export const TOP_SPEED_MPS = 1.5; // of the colours of points
export type Layer = "room" | "planes" | "free" | "points" | "static" | "trail" | "view" | "grid" | "camera" | "rays";
const STILL: Layer[] = ["room", "planes", "grid", "view", "camera", "free"]; // drawn once for each view

export class SceneView {
  readonly root = element("div", { class: "scene" });
  onFloor: (place: [number, number]) => void = () => {};
  onPath: (path: [number, number][]) => void = () => {};
  onBody: (inside: boolean) => void = () => {};
  onNudge: (right: number, ahead: number) => void = () => {};
  onCorner: () => void = () => {};
  drawing = false;
  draws = 0; // pictures so far, for tests and benchmarks
  readonly isSoftware: boolean;
  private renderer: THREE.WebGLRenderer;
  private scene = new THREE.Scene();
  private still = new THREE.Scene();
  private picture = new StillPicture();
  private camera = new THREE.PerspectiveCamera(50, 1, 0.05, 80);
  private orbit: OrbitControls;
  private layers: Record<string, THREE.Object3D> = {};
  private bodies: Body[] = [];
  private otherBodies: Body[] = []; // of B, pale
  private detections = [new Detections(true), new Detections(false)];
  private sequence: Sequence | null = null;
  private other: Sequence | null = null;
  private floorZ = -1;
  private ghost: THREE.Mesh;
  private drawn: [number, number][] = [];
  private hidden = new Set<Layer>(["planes", "free", "static", "camera"]);
  private pending = false;

  constructor() {
    this.isSoftware = isSoftware();
    this.renderer = new THREE.WebGLRenderer({ antialias: !this.isSoftware, alpha: false, stencil: false });
    const canvas = this.renderer.domElement;
    canvas.setAttribute("role", "img"); canvas.setAttribute("tabindex", "0");
    canvas.setAttribute("aria-label", "The room in 3D with people and radar points. Click the floor, or press Shift and an arrow key, to choose where the person starts; drag to turn, scroll to zoom.");
    this.root.append(canvas);
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.addEventListener("change", () => { this.picture.isOld = true; this.render(); });
    for (const scene of [this.scene, this.still]) {
      scene.add(new THREE.HemisphereLight(0xffffff, 0x556070, 1.6));
      const sun = new THREE.DirectionalLight(0xffffff, 1.8); sun.position.set(-1, -2, 4); scene.add(sun);
    }
    this.ghost = new THREE.Mesh(new THREE.RingGeometry(0.16, 0.21, 40), new THREE.MeshBasicMaterial({ color: "#00a7d6", side: THREE.DoubleSide }));
    this.ghost.visible = false;
    this.scene.add(this.ghost, ...this.detections.map((one) => one.object), this.picture.quad);
    this.home();
    this.listen(canvas);
    new ResizeObserver(() => this.resize()).observe(this.root);
  }

  private listen(canvas: HTMLCanvasElement): void {
    let down: [number, number] | null = null, dragged = false;
    canvas.addEventListener("pointerdown", (event) => {
      down = [event.clientX, event.clientY];
      dragged = !this.drawing && (this.hitsBody(event) || this.hitsRing(event));
      if (this.drawing || dragged) this.orbit.enabled = false;
      if (this.drawing) this.drawn = [];
      if (dragged) this.reveal("free", true);
    });
    canvas.addEventListener("pointermove", (event) => {
      const place = down && dragged ? this.floorAt(event) : null;
      if (this.drawing && down) this.drawTo(event);
      else if (place) this.showStart(place);
      else if (!event.buttons) { const inside = this.hitsBody(event); canvas.style.cursor = inside || this.hitsRing(event) ? "grab" : ""; this.onBody(inside); }
    });
    canvas.addEventListener("pointerup", (event) => {
      const start = down; down = null; this.orbit.enabled = true; this.reveal("free", false);
      if (!start) return;
      if (this.drawing && this.drawn.length > 1) { this.onPath(this.drawn); return; }
      if (!dragged && Math.hypot(event.clientX - start[0], event.clientY - start[1]) > CLICK_PX) return;
      const place = this.floorAt(event);
      if (place) this.onFloor(place);
    });
    canvas.addEventListener("pointerleave", () => this.onBody(false));
    canvas.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (event.key === "Enter") this.onCorner();
      else if (by && event.shiftKey) this.onNudge(by[0], by[1]);
      else return;
      event.preventDefault(); event.stopPropagation();
    });
  }

  /** The camera's usual place: behind and above the radar, so that the range window fills the view. */
  home(): void {
    const far = Math.min(this.sequence?.header.range_m[1] ?? 3.5, 12), k = far / 3.5;
    this.camera.position.set(1.5 * k, -2.2 * k, 1.6 * k); this.orbit.target.set(0.1, 1.9 * k, -0.35); this.orbit.update();
  }

  show(layer: Layer, visible: boolean): void { if (visible) this.hidden.delete(layer); else this.hidden.add(layer); this.reveal(layer, false); }
  isShown(layer: Layer): boolean { return !this.hidden.has(layer); }
  /** Shows a layer for as long as it is needed, whatever is chosen. */
  private reveal(layer: Layer, visible: boolean): void {
    const object = this.layers[layer];
    if (object) { object.visible = visible || !this.hidden.has(layer); if (STILL.includes(layer)) this.picture.isOld = true; }
    this.refreshPoints(); this.render();
  }

  setRoom(room: RoomView | null): void {
    for (const name of ["room", "planes", "free", "camera"]) this.drop(name);
    if (!room) { this.render(); return; }
    this.floorZ = room.header.floor_z_m;
    this.put("room", surface(room, () => { this.picture.isOld = true; this.render(); }));
    this.put("free", freeFloor(room));
    const planes = new THREE.Group();
    for (const plane of room.header.planes) {
      const c = plane.corners_m.flat(), shape = new THREE.BufferGeometry();
      shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(c), 3)); shape.setIndex([0, 1, 2, 0, 2, 3]); shape.computeVertexNormals();
      const colour = plane.reflects ? "#e4572e" : plane.kind === "floor" ? "#6b7683" : "#4a90c2";
      planes.add(new THREE.Mesh(shape, new THREE.MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false })), line([...c, ...c.slice(0, 3)], colour));
    }
    this.put("planes", planes);
    if (room.header.camera_corners_m) this.put("camera", frustum(room));
    this.render();
  }

  /** The people and the radar's view of a sequence; those of `other` are pale. None of either empties the room. */
  setSequence(sequence: Sequence | null, other: Sequence | null = null): void {
    const goesOn = sequence && this.sequence && !other && sequence.version > 1 && sequence.people === this.bodies.length;
    if (goesOn) { this.sequence = sequence; this.bodies.forEach((body) => body.follow(sequence)); this.detections[0].set(sequence); this.setTrail(); return; }
    const window = (one: Sequence | null) => JSON.stringify(one && [one.header.range_m, one.header.azimuth_rad]), isNew = window(this.sequence) !== window(sequence), isFirst = this.sequence === null;
    this.sequence = sequence; this.other = other;
    for (const body of [...this.bodies, ...this.otherBodies]) { this.scene.remove(body.group); body.dispose(); }
    const bodiesOf = (one: Sequence | null, shift: number) => Array.from({ length: one?.people ?? 0 }, (_, p) => new Body(one!, p, PEOPLE[(p + shift) % PEOPLE.length], this.floorZ, shift > 0));
    this.bodies = bodiesOf(sequence, 0); this.otherBodies = bodiesOf(other, LIVING_PALE);
    for (const body of [...this.bodies, ...this.otherBodies]) this.scene.add(body.group);
    this.detections[0].set(sequence); this.detections[1].set(other);
    this.setTrail(); this.showRays(null, null);
    if (sequence) { this.put("view", fieldOfView(sequence, this.floorZ)); this.put("grid", rings(sequence, this.floorZ)); } else { this.drop("view"); this.drop("grid"); }
    if (isNew && (isFirst || sequence)) this.home();
    this.render();
  }
  private setTrail(): void {
    const trail = new THREE.Group();
    for (const [one, shift] of [[this.sequence, 0], [this.other, LIVING_PALE]] as const)
      for (let p = 0; p < (one?.people ?? 0); p++) {
        const path: number[] = [];
        for (let f = 0; f < one!.frames; f++) { const [x, y] = one!.joint(p, f, 0); path.push(x, y, this.floorZ + 0.03); }
        trail.add(line(path, PEOPLE[(p + shift) % PEOPLE.length]));
      }
    this.put("trail", trail);
  }

  /** Frame `frame`, `share` of the way to the next, and the same of B, whose points are squares. */
  showFrame(frame: number, share: number, frameB = 0, shareB = 0): void {
    for (const body of this.bodies) body.show(frame, share);
    for (const body of this.otherBodies) body.show(frameB, shareB);
    this.detections[0].frame = frame; this.detections[1].frame = frameB;
    this.refreshPoints(); this.render();
  }
  private refreshPoints(): void { for (const one of this.detections) one.show(!this.hidden.has("points"), !this.hidden.has("static")); }
  /** Number of radar points drawn, for tests. */
  get pointsDrawn(): number { return this.detections.reduce((sum, one) => sum + one.count, 0); }
  get people(): number { return this.bodies.length; }

  /** The ring where the person will start; null hides it. */
  showStart(place: [number, number] | null): void {
    this.ghost.visible = place !== null;
    if (place) this.ghost.position.set(place[0], place[1], this.floorZ + 0.04);
    this.render();
  }

  /** Propagation paths of a frame as rays, the chosen ones (all without a choice) coloured by kind and as opaque as strong. */
  showRays(rays: Rays | null, chosen: number[] | null): void {
    this.drop("rays");
    if (rays) {
      const group = new THREE.Group(), top = rays.level[0] ?? 0;
      for (const i of chosen ?? strongest(rays)) {
        const opacity = chosen ? 0.95 : Math.max(0.12, 1 - (top - rays.level[i]) / 50), made = line(rays.points[i].flat(), KINDS[rays.kind[i]][1]), material = made.material as THREE.LineBasicMaterial;
        material.transparent = true; material.opacity = opacity; material.depthTest = false; made.renderOrder = 2;
        group.add(made);
      }
      this.put("rays", group);
    }
    this.render();
  }

  /** The arc of a range and the ray of an azimuth, as far as they are given. */
  showCell(rangeM: number | null, azimuthRad: number | null): void {
    const now = this.layers.cell?.userData;
    if ((now?.rangeM ?? null) === rangeM && (now?.azimuthRad ?? null) === azimuthRad) return;
    this.drop("cell");
    if (this.sequence && (rangeM !== null || azimuthRad !== null)) {
      const cell = new THREE.Group(), [left, right] = this.sequence.header.azimuth_rad, far = this.sequence.header.range_m[1];
      if (rangeM !== null) cell.add(line(arc(rangeM, left, right, this.floorZ + 0.05), "#00d0ff"), line(arc(rangeM, left, right, 0), "#00d0ff"));
      if (azimuthRad !== null) cell.add(line([0, 0, 0, far * Math.sin(azimuthRad), far * Math.cos(azimuthRad), 0], "#00d0ff"));
      cell.userData = { rangeM, azimuthRad };
      this.put("cell", cell);
    }
    this.render();
  }

  /** For tests and screen readers: the range of the arc that is drawn, measured on its geometry; null without one. */
  arcRangeM(): number | null {
    const shown = this.layers.cell?.children[0] as THREE.Line | undefined;
    if (!shown || this.layers.cell.userData.rangeM === null) return null;
    const p = shown.geometry.getAttribute("position");
    return Math.hypot(p.getX(0), p.getY(0));
  }
  /** Rays drawn, for tests. */
  get raysDrawn(): number { return this.layers.rays?.children.length ?? 0; }

  /** Where a place of the floor appears, in pixels of the page. */
  toPage(x: number, y: number, z = this.floorZ): [number, number] {
    const p = new THREE.Vector3(x, y, z).project(this.camera), box = this.renderer.domElement.getBoundingClientRect();
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
  get element(): HTMLCanvasElement { this.draw(); return this.renderer.domElement; }
  dispose(): void { this.picture.dispose(); this.renderer.dispose(); this.renderer.forceContextLoss(); }

  private ray(event: PointerEvent): THREE.Raycaster {
    const box = this.renderer.domElement.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), this.camera);
    return caster;
  }
  private floorAt(event: PointerEvent): [number, number] | null {
    const hit = new THREE.Vector3();
    return this.ray(event).ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), -this.floorZ), hit) ? [hit.x, hit.y] : null;
  }
  private hitsBody(event: PointerEvent): boolean { return this.bodies.length > 0 && this.ray(event).intersectObjects(this.bodies.map((body) => body.group), true).length > 0; }
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
  /** A line over the floor; null removes it. */
  showPath(path: [number, number][] | null): void {
    if (path?.length) this.put("path", line(path.flatMap(([x, y]) => [x, y, this.floorZ + 0.05]), "#00a7d6")); else this.drop("path");
    this.render();
  }
  private put(name: string, object: THREE.Object3D): void {
    this.drop(name);
    object.visible = !this.hidden.has(name as Layer);
    this.layers[name] = object;
    if (STILL.includes(name as Layer)) { this.still.add(object); this.picture.isOld = true; } else this.scene.add(object);
  }
  private drop(name: string): void {
    const old = this.layers[name];
    if (!old) return;
    old.removeFromParent(); delete this.layers[name];
    if (STILL.includes(name as Layer)) this.picture.isOld = true;
    old.traverse((o: any) => { o.geometry?.dispose(); o.material?.map?.dispose(); o.material?.dispose(); });
  }
  private resize(): void {
    const { clientWidth: w, clientHeight: h } = this.root;
    if (!w || !h) return;
    this.renderer.setPixelRatio(this.isSoftware ? 1 : Math.min(devicePixelRatio || 1, 2)); this.renderer.setSize(w, h);
    this.camera.aspect = w / h; this.camera.updateProjectionMatrix();
    this.picture.resize(this.renderer);
    this.draw(); // at once: setting the size has cleared the canvas
  }
  render(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(); });
  }
  private draw(): void {
    const colour = themeColour(this.root, "--backdrop") || "#14161a";
    this.picture.draw(this.renderer, this.still, this.camera, colour);
    this.renderer.render(this.scene, this.camera);
    this.draws++;
  }
  themeChanged(): void { this.picture.isOld = true; if (this.sequence) { this.put("grid", rings(this.sequence, this.floorZ)); } this.render(); }
}

/** Whether the processor draws: then every pixel counts, and what a screen would smooth is left as it is. */
function isSoftware(): boolean {
  const g = document.createElement("canvas").getContext("webgl"), info = g?.getExtension("WEBGL_debug_renderer_info");
  const is = /swiftshader|llvmpipe|software/i.test(String(info ? g!.getParameter(info.UNMASKED_RENDERER_WEBGL) : ""));
  g?.getExtension("WEBGL_lose_context")?.loseContext();
  return is;
}

/** The radar points of a sequence in one buffer, of which a frame's are drawn: moving ones, and static ones where wanted. */
class Detections {
  readonly object: THREE.Points;
  frame = 0;
  count = 0;
  private sequence: Sequence | null = null;
  private capacity = 0;
  constructor(isRound: boolean) {
    const material = new THREE.PointsMaterial({ size: isRound ? 0.085 : 0.07, vertexColors: true, depthTest: false }); // echoes lie on and in the body that would hide them
    if (isRound) { material.map = dot(); material.alphaTest = 0.5; }
    this.object = new THREE.Points(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false; this.object.renderOrder = 1;
  }
  set(sequence: Sequence | null): void { this.sequence = sequence; }
  show(withMoving: boolean, withStatic: boolean): void {
    const { sequence } = this, first = sequence?.pointStart[this.frame] ?? 0, last = sequence?.pointStart[this.frame + 1] ?? 0;
    if (last - first > this.capacity) {
      this.capacity = 2 * (last - first);
      for (const name of ["position", "color"]) this.object.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * this.capacity), 3).setUsage(THREE.DynamicDrawUsage));
    }
    this.count = 0;
    if (sequence && last > first) {
      const { data } = sequence.arrays.points, slowest = sequence.slowestMps, place = this.object.geometry.getAttribute("position"), colour = this.object.geometry.getAttribute("color");
      for (let k = first; k < last; k++) {
        const v = data[5 * k + 3], isStatic = Math.abs(v) < slowest;
        if (isStatic ? !withStatic : !withMoving) continue;
        place.setXYZ(this.count, data[5 * k], data[5 * k + 1], data[5 * k + 2]); colour.setXYZ(this.count++, ...velocityColour(v, TOP_SPEED_MPS));
      }
      place.needsUpdate = colour.needsUpdate = true;
    }
    this.object.geometry.setDrawRange(0, this.count);
    this.object.visible = this.count > 0;
  }
}

function dot(): THREE.Texture {
  const canvas = element("canvas", { width: 32, height: 32 }), g = canvas.getContext("2d")!;
  g.fillStyle = "#fff"; g.beginPath(); g.arc(16, 16, 15, 0, 7); g.fill();
  return new THREE.CanvasTexture(canvas);
}

/** The surface that the photo saw, with the photo on it; from behind it is not there, so that nothing hides the room. */
function surface(room: RoomView, loaded: () => void): THREE.Object3D {
  const { room_points: mm, room_faces: faces, room_uv: uv, room_photo: photo } = room.arrays, shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(mm.data, (value) => value / 1000), 3));
  shape.setAttribute("uv", new THREE.BufferAttribute(Float32Array.from(uv.data, (value) => value / 32767), 2));
  shape.setIndex(new THREE.BufferAttribute(new Uint32Array(faces.data), 1));
  const material = new THREE.MeshBasicMaterial({ color: "#9aa3ad" });
  createImageBitmap(new Blob([photo.data as BlobPart], { type: "image/jpeg" })).then((picture) => {
    const map = new THREE.Texture(picture as any); map.flipY = false; map.colorSpace = THREE.SRGBColorSpace; map.generateMipmaps = false; map.minFilter = THREE.LinearFilter; map.needsUpdate = true;
    material.map = map; material.color.set("#ffffff"); material.needsUpdate = true; loaded();
  }, () => {});
  const mesh = new THREE.Mesh(shape, material);
  mesh.frustumCulled = false;
  return mesh;
}

function freeFloor(room: RoomView): THREE.Object3D {
  const cells = room.arrays.free_floor.data, standable = room.arrays.standable.data, half = room.header.cell_m / 2, z = room.header.floor_z_m + 0.012, place: number[] = [];
  for (let i = 0; i < cells.length; i += 2) {
    if (!standable[i / 2]) continue;
    const [x, y] = [cells[i], cells[i + 1]];
    place.push(x - half, y - half, z, x + half, y - half, z, x + half, y + half, z, x - half, y - half, z, x + half, y + half, z, x - half, y + half, z);
  }
  const shape = new THREE.BufferGeometry(); shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(place), 3));
  return new THREE.Mesh(shape, new THREE.MeshBasicMaterial({ color: "#2fbf7b", transparent: true, opacity: 0.3, depthWrite: false }));
}

/** The camera's pyramid of view; the radar stands where the photo was taken from. */
function frustum(room: RoomView): THREE.Object3D {
  const group = new THREE.Group(), corners: number[][] = room.header.camera_corners_m, at: number[] = room.header.camera_m;
  for (const corner of corners) group.add(line([...at, ...corner], "#b07cff"));
  group.add(line([...corners.flat(), ...corners[0]], "#b07cff"));
  return group;
}

/** The board on a stand, and its field of view on the floor. */
function fieldOfView(sequence: Sequence, floorZ: number): THREE.Object3D {
  const [near, far] = sequence.header.range_m, [left, right] = sequence.header.azimuth_rad, view = new THREE.Group(), z = floorZ + 0.02, from = Math.max(near, 0), steps = 40, fan: number[] = [];
  for (let k = 0; k < steps; k++) {
    const [a, b] = [left + ((right - left) * k) / steps, left + ((right - left) * (k + 1)) / steps], at = (r: number, t: number) => [r * Math.sin(t), r * Math.cos(t), z - 0.005];
    fan.push(...at(from, a), ...at(far, a), ...at(far, b), ...at(from, a), ...at(far, b), ...at(from, b));
  }
  const shape = new THREE.BufferGeometry(); shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(fan), 3));
  view.add(new THREE.Mesh(shape, new THREE.MeshBasicMaterial({ color: "#00a7d6", transparent: true, opacity: 0.05, side: THREE.DoubleSide, depthWrite: false })));
  for (const r of [from, far]) view.add(line(arc(r, left, right, z), "#00a7d6"));
  for (const t of [left, right]) view.add(line([from * Math.sin(t), from * Math.cos(t), z, far * Math.sin(t), far * Math.cos(t), z], "#00a7d6"));
  const solid = (shape: THREE.BufferGeometry, colour: string, place: [number, number, number]) => { const mesh = new THREE.Mesh(shape, new THREE.MeshStandardMaterial({ color: colour, roughness: 0.6 })); mesh.position.set(...place); view.add(mesh); };
  solid(new THREE.BoxGeometry(0.12, 0.02, 0.1), "#b3261e", [0, 0, 0]); solid(new THREE.BoxGeometry(0.035, 0.012, 0.035), "#20242a", [0, 0.014, 0.012]);
  const stand = new THREE.CylinderGeometry(0.012, 0.02, -floorZ - 0.05, 10); stand.rotateX(Math.PI / 2); solid(stand, "#59616b", [0, 0, (floorZ - 0.05) / 2]);
  return view;
}

/** Rings of equal range on the floor with their metres, and the direction of boresight. */
function rings(sequence: Sequence, floorZ: number): THREE.Object3D {
  const far = sequence.header.range_m[1], [left, right] = sequence.header.azimuth_rad, step = far > 12 ? 5 : far > 6 ? 2 : 1, group = new THREE.Group();
  for (let r = step; r < far; r += step) { group.add(line(arc(r, left, right, floorZ + 0.018), "#6f8ea0")); group.add(label(`${r} m`, [r * Math.sin(right), r * Math.cos(right), floorZ + 0.06], far / 30)); }
  group.add(line([0, 0, floorZ + 0.018, 0, far, floorZ + 0.018], "#6f8ea0"), label(`${far.toFixed(1)} m`, [far * Math.sin(right), far * Math.cos(right), floorZ + 0.06], far / 30));
  for (const [to, colour] of [[[0.25, 0, 0], "#d64545"], [[0, 0.25, 0], "#3fa34d"], [[0, 0, 0.25], "#3d7be0"]] as const) group.add(line([0, 0, 0, ...to], colour)); // x right, y ahead, z up
  return group;
}
function label(text: string, place: [number, number, number], size: number): THREE.Sprite {
  const canvas = element("canvas", { width: 128, height: 48 }), g = canvas.getContext("2d")!;
  g.font = '600 30px system-ui, "DejaVu Sans", sans-serif'; g.textAlign = "center"; g.textBaseline = "middle"; g.lineWidth = 6; g.strokeStyle = "rgba(255,255,255,.85)"; g.strokeText(text, 64, 24); g.fillStyle = "#245"; g.fillText(text, 64, 24);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false, transparent: true }));
  sprite.position.set(...place); sprite.scale.set(size * 2.6, size, 1);
  return sprite;
}
function line(place: ArrayLike<number>, colour: string): THREE.Line {
  const shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(place), 3));
  const made = new THREE.Line(shape, new THREE.LineBasicMaterial({ color: colour }));
  made.frustumCulled = false;
  return made;
}
function arc(r: number, left: number, right: number, z: number): number[] {
  return Array.from({ length: 49 }, (_, k) => left + ((right - left) * k) / 48).flatMap((t) => [r * Math.sin(t), r * Math.cos(t), z]);
}
