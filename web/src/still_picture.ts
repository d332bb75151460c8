// What does not move is drawn once for each view, with its depth, and laid under every frame: the room costs nothing while people move.
import * as THREE from "three";

export class StillPicture {
  isOld = true;
  readonly quad: THREE.Mesh;
  private target = new THREE.WebGLRenderTarget(1, 1, { samples: 4, depthTexture: new THREE.DepthTexture(1, 1) });
  constructor() {
    const material = new THREE.ShaderMaterial({
      uniforms: { colour: { value: this.target.texture }, depth: { value: this.target.depthTexture } }, depthFunc: THREE.AlwaysDepth,
      vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: "uniform sampler2D colour; uniform sampler2D depth; varying vec2 at; void main() { gl_FragColor = linearToOutputTexel(texture2D(colour, at)); gl_FragDepth = texture2D(depth, at).r; }",
    });
    this.quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
    this.quad.frustumCulled = false; this.quad.renderOrder = -1;
    this.quad.raycast = () => {};
  }
  resize(renderer: THREE.WebGLRenderer): void {
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    this.target.setSize(size.x, size.y);
    this.isOld = true;
  }
  draw(renderer: THREE.WebGLRenderer, scene: THREE.Scene, camera: THREE.Camera, background: string): void {
    if (!this.isOld) return;
    this.isOld = false;
    scene.background = new THREE.Color(background);
    renderer.setRenderTarget(this.target); renderer.render(scene, camera); renderer.setRenderTarget(null);
  }
  dispose(): void { this.target.dispose(); this.quad.geometry.dispose(); }
}
