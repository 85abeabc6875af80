// The scene: a view in perspective and one from above, drawn only when something changes.
import {
  Box3, BufferAttribute, BufferGeometry, Color as ThreeColor, ColorManagement, Group, LineBasicMaterial, LinearSRGBColorSpace, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, OrthographicCamera, PerspectiveCamera, Points, PointsMaterial, Quaternion,
  Scene as ThreeScene, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import { MapControls } from "three/addons/controls/MapControls.js";
import type { Pose, Vector } from "../api/types";
import type { Color } from "./colors";
import { VOXEL_M, type MapLayer } from "./map_layer";

/** Longest time to draw one picture while the view moves, milliseconds. */
const FRAME_MS = 40;
const BACKGROUND = 0x0f1720;

// Colors are drawn as they are stated, so that points, lines and the legend have the same ones.
ColorManagement.enabled = false;

export interface Line {
  from: Vector3;
  to: Vector3;
  color: Color;
}

export interface Picked {
  layer: MapLayer;
  row: number;
}

export class View {
  readonly layers = new Map<string, MapLayer>();
  /** Points drawn in the last picture, and of all. */
  drawn = 0;
  total = 0;
  frames = 0;
  onFrame: () => void = () => undefined;
  private readonly scene = new ThreeScene();
  private readonly overlays = new Map<string, Group>();
  private readonly renderer: WebGLRenderer;
  private readonly perspective = new PerspectiveCamera(55, 1, 0.1, 100_000);
  private readonly above = new OrthographicCamera(-1, 1, 1, -1, -100_000, 100_000);
  private readonly controls: Record<"perspective" | "above", MapControls>;
  private mode: "perspective" | "above" = "perspective";
  private budget = 300_000;
  private wasMoving = false;
  private moving = 0;
  private lastDraw = 0;
  private scheduled = false;
  private readonly marker: Mesh;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: false, powerPreference: "high-performance", preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene.background = new ThreeColor(BACKGROUND);
    this.perspective.up.set(0, 0, 1);
    this.perspective.position.set(-60, -60, 60);
    this.above.up.set(0, 1, 0);
    this.above.position.set(0, 0, 1000);
    this.controls = {
      perspective: this.control(this.perspective),
      above: this.control(this.above),
    };
    this.controls.above.enableRotate = false;
    this.controls.above.enabled = false;
    this.marker = new Mesh(new SphereGeometry(1, 24, 16), new MeshBasicMaterial({ color: 0xffffff, transparent: true, opacity: 0.6, depthTest: false }));
    this.marker.visible = false;
    this.scene.add(this.marker);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  private control(camera: PerspectiveCamera | OrthographicCamera): MapControls {
    const controls = new MapControls(camera, this.canvas);
    controls.enableDamping = false;
    controls.maxPolarAngle = 0.49 * Math.PI;
    controls.addEventListener("change", () => this.move());
    return controls;
  }

  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.mode === "above" ? this.above : this.perspective;
  }

  get isAbove(): boolean {
    return this.mode === "above";
  }

  get target(): Vector3 {
    return this.controls[this.mode].target;
  }

  setAbove(above: boolean): void {
    if (above === this.isAbove) return;
    const target = this.target.clone();
    const reach = this.reach();
    this.controls[this.mode].enabled = false;
    this.mode = above ? "above" : "perspective";
    const controls = this.controls[this.mode];
    controls.enabled = true;
    this.look(target, reach);
  }

  /** Half the height that the view shows at its target, meters. */
  reach(): number {
    if (this.isAbove) return this.above.top / this.above.zoom;
    return this.perspective.position.distanceTo(this.target) * Math.tan((this.perspective.fov * Math.PI) / 360);
  }

  look(target: Vector3, reach: number): void {
    const controls = this.controls[this.mode];
    if (this.isAbove) {
      this.above.zoom = this.above.top / Math.max(reach, 0.5);
      this.above.position.set(target.x, target.y, 1000);
      this.above.updateProjectionMatrix();
    } else {
      const away = this.perspective.position.clone().sub(controls.target);
      if (away.lengthSq() < 1e-6 || away.z < 0.2 * away.length()) away.set(-1, -1, 1.1);
      away.setLength(Math.max(reach, 0.5) / Math.tan((this.perspective.fov * Math.PI) / 360));
      this.perspective.position.copy(target).add(away);
    }
    controls.target.copy(target);
    controls.update();
    this.move();
  }

  /** Show all maps, or one. */
  fit(name?: string): void {
    const box = new Box3();
    for (const [key, layer] of this.layers) {
      if (name !== undefined && key !== name) continue;
      box.union(new Box3(layer.low.clone(), layer.high.clone()).applyMatrix4(layer.pose));
    }
    if (box.isEmpty()) return;
    const size = box.getSize(new Vector3());
    const aspect = this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1);
    this.look(box.getCenter(new Vector3()), 0.55 * Math.max(size.y, size.x / aspect, 10));
  }

  pan(right: number, forward: number): void {
    const reach = this.reach();
    const ahead = this.isAbove ? new Vector3(0, 1, 0) : this.target.clone().sub(this.perspective.position).setZ(0).normalize();
    const side = new Vector3(ahead.y, -ahead.x, 0);
    const step = ahead.multiplyScalar(forward * reach * 0.2).add(side.multiplyScalar(right * reach * 0.2));
    this.camera.position.add(step);
    this.target.add(step);
    this.controls[this.mode].update();
    this.move();
  }

  zoom(factor: number): void {
    this.look(this.target.clone(), this.reach() / factor);
  }

  turn(radians: number): void {
    if (this.isAbove) return;
    const away = this.perspective.position.clone().sub(this.target).applyAxisAngle(new Vector3(0, 0, 1), radians);
    this.perspective.position.copy(this.target).add(away);
    this.controls.perspective.update();
    this.move();
  }

  /** Angle from the picture's upward direction to the map's y axis, radians, clockwise. */
  north(): number {
    if (this.isAbove) return 0;
    const ahead = this.target.clone().sub(this.perspective.position);
    return Math.atan2(-ahead.x, ahead.y);
  }

  add(layer: MapLayer): void {
    this.remove(layer.content.name);
    this.layers.set(layer.content.name, layer);
    this.scene.add(layer.group);
    this.redraw();
  }

  remove(name: string): void {
    const layer = this.layers.get(name);
    if (!layer) return;
    this.layers.delete(name);
    this.scene.remove(layer.group);
    layer.dispose();
    this.redraw();
  }

  /** Replace the lines and points of an overlay; empty ones remove it. */
  overlay(name: string, lines: Line[], clouds: { points: Vector3[]; colors: Color[]; size: number }[] = []): void {
    const before = this.overlays.get(name);
    if (before) {
      this.scene.remove(before);
      before.traverse((each) => {
        if (each instanceof LineSegments || each instanceof Points) {
          each.geometry.dispose();
          (each.material as LineBasicMaterial).dispose();
        }
      });
      this.overlays.delete(name);
    }
    const group = new Group();
    const anchor = (lines[0]?.from ?? clouds[0]?.points[0] ?? new Vector3()).clone();
    group.position.copy(anchor);
    if (lines.length) {
      const geometry = geometryOf(lines.flatMap(({ from, to }) => [from, to]), lines.flatMap(({ color }) => [color, color]), anchor);
      group.add(new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, depthTest: false })));
    }
    for (const cloud of clouds.filter((each) => each.points.length)) {
      const geometry = geometryOf(cloud.points, cloud.colors, anchor);
      group.add(new Points(geometry, new PointsMaterial({ vertexColors: true, size: cloud.size, sizeAttenuation: false, depthTest: true })));
    }
    group.traverse((each) => (each.frustumCulled = false));
    if (group.children.length) {
      this.overlays.set(name, group);
      this.scene.add(group);
    }
    this.redraw();
  }

  mark(position: Vector3 | null, size = 1): void {
    this.marker.visible = position !== null;
    if (position) {
      this.marker.position.copy(position);
      this.marker.scale.setScalar(size);
    }
    this.redraw();
  }

  pick(x: number, y: number): Picked | null {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.camera.updateMatrixWorld();
    let best: Picked | null = null;
    let distance = 14;
    for (const layer of this.layers.values()) {
      const found = layer.pick(this.camera, x, y, width, height, distance);
      if (found.row >= 0 && found.distance < distance) {
        best = { layer, row: found.row };
        distance = found.distance;
      }
    }
    return best;
  }

  /** Pixel of a place in the scene; null if the place is not in the picture. */
  project(place: Vector3): [number, number] | null {
    this.camera.updateMatrixWorld();
    const at = place.clone().project(this.camera);
    if (Math.abs(at.x) > 1 || Math.abs(at.y) > 1 || Math.abs(at.z) > 1) return null;
    return [((at.x + 1) / 2) * this.canvas.clientWidth, ((1 - at.y) / 2) * this.canvas.clientHeight];
  }

  /** Place on the plane z = height under a pixel; null above the horizon. */
  ground(x: number, y: number, height = this.target.z): Vector3 | null {
    const { clientWidth, clientHeight } = this.canvas;
    const at = new Vector3((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight, 0).unproject(this.camera);
    if (this.isAbove) return at.setZ(height);
    const ray = at.clone().sub(this.perspective.position);
    const share = (height - this.perspective.position.z) / ray.z;
    return share > 0 ? this.perspective.position.clone().add(ray.multiplyScalar(share)) : null;
  }

  /** Meters a pixel at the target. */
  scale(): number {
    return (2 * this.reach()) / Math.max(this.canvas.clientHeight, 1);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    const top = 100;
    this.above.zoom *= top / this.above.top;
    [this.above.left, this.above.right, this.above.top, this.above.bottom] = [(-top * width) / height, (top * width) / height, top, -top];
    this.above.updateProjectionMatrix();
    this.redraw();
  }

  private move(): void {
    this.moving = performance.now();
    this.schedule();
  }

  /** Draw again, after something has changed. */
  redraw(): void {
    this.schedule();
  }

  private schedule(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.draw();
    });
  }

  /** While the view moves, draw as many points as fit the time; at rest draw all. */
  private draw(): void {
    const started = performance.now();
    // A picture may take longer than this time: then a movement since the last one tells it.
    const moving = started - this.moving < 250 || this.moving > this.lastDraw;
    this.total = [...this.layers.values()].reduce((sum, each) => sum + each.content.ids.length, 0);
    const share = moving ? Math.min(1, this.budget / Math.max(this.total, 1)) : 1;
    this.drawn = 0;
    // Meters into pixels: everywhere the same from above, else at a distance of one meter.
    const half = this.canvas.height / 2;
    const pixels = this.isAbove ? half / this.reach() : half / Math.tan((this.perspective.fov * Math.PI) / 360);
    for (const layer of this.layers.values()) {
      this.drawn += layer.limit(Math.ceil(share * layer.content.ids.length));
      layer.points.material.uniforms["size"]!.value = this.isAbove ? 2.5 : 0.6;
      layer.points.material.uniforms["perspective"]!.value = this.isAbove ? 0 : half;
      layer.shapes.material.uniforms["size"]!.value = this.isAbove ? VOXEL_M * pixels : VOXEL_M;
      layer.shapes.material.uniforms["perspective"]!.value = this.isAbove ? 0 : pixels;
    }
    this.camera.updateMatrixWorld();
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
    // Drawing returns before the picture is there. The browser asks for the next picture only when
    // it has shown the last one, so the time between two pictures of one movement tells the effort.
    const between = started - this.lastDraw;
    this.lastDraw = started;
    if (moving && this.wasMoving && this.drawn > 1000) {
      const fitting = (this.drawn * FRAME_MS) / Math.max(between, 1);
      this.budget = Math.max(20_000, 0.7 * this.budget + 0.3 * fitting);
    }
    this.wasMoving = moving;
    this.onFrame();
    if (moving && share < 1) setTimeout(() => this.schedule(), 260);
  }
}

function geometryOf(points: Vector3[], colors: Color[], anchor: Vector3): BufferGeometry {
  const geometry = new BufferGeometry();
  const places = new Float32Array(points.flatMap((point) => [point.x - anchor.x, point.y - anchor.y, point.z - anchor.z]));
  geometry.setAttribute("position", new BufferAttribute(places, 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colors.flat()), 3));
  return geometry;
}

/** Matrix of a pose of the API. */
export function matrixOf(pose: Pick<Pose, "translation" | "rotation">): Matrix4 {
  return new Matrix4().compose(
    new Vector3(...pose.translation), new Quaternion(...pose.rotation), new Vector3(1, 1, 1),
  );
}

export const vector = (value: Vector): Vector3 => new Vector3(...value);

/** Lines of an ellipse around a place: two standard deviations of x and y. */
export function ellipse(place: Vector3, covariance: number[][], color: Color): Line[] {
  const [a, b, d] = [covariance[0]?.[0] ?? 0, covariance[0]?.[1] ?? 0, covariance[1]?.[1] ?? 0];
  const middle = (a + d) / 2;
  const spread = Math.sqrt(Math.max(0, ((a - d) / 2) ** 2 + b * b));
  const [long, short] = [2 * Math.sqrt(Math.max(middle + spread, 0)), 2 * Math.sqrt(Math.max(middle - spread, 0))];
  const heading = 0.5 * Math.atan2(2 * b, a - d);
  const at = (angle: number): Vector3 => {
    const [u, v] = [long * Math.cos(angle), short * Math.sin(angle)];
    return place.clone().add(new Vector3(u * Math.cos(heading) - v * Math.sin(heading), u * Math.sin(heading) + v * Math.cos(heading), 0));
  };
  const steps = 32;
  return Array.from({ length: steps }, (_, step) => ({
    from: at((2 * Math.PI * step) / steps), to: at((2 * Math.PI * (step + 1)) / steps), color,
  }));
}

/** Lines of an arrow on the ground: where a robot stands and looks. */
export function arrow(pose: Matrix4, length: number, color: Color): Line[] {
  const at = (x: number, y: number, z = 0): Vector3 => new Vector3(x, y, z).multiplyScalar(length).applyMatrix4(pose);
  const outline: [number, number][] = [[1, 0], [-0.6, 0.55], [-0.25, 0], [-0.6, -0.55], [1, 0]];
  const lines = outline.slice(1).map(([x, y], index) => ({ from: at(...outline[index]!), to: at(x, y), color }));
  return [...lines, { from: at(0, 0), to: at(0, 0, 0.8), color }];
}
