// One map in the scene: its segments as points, and the paths of its robots.
import {
  BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Points,
  ShaderMaterial, type PerspectiveCamera, type OrthographicCamera, Vector3,
} from "three";
import { rowOf, type MapContent } from "../api/map_file";
import type { Color } from "./colors";

const VERTEX = `
attribute vec3 tint;
varying vec3 vTint;
uniform float size;
uniform float perspective;
uniform float least;
uniform float most;
void main() {
  vTint = tint;
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * place;
  gl_PointSize = clamp(perspective > 0.0 ? size * perspective / -place.z : size, least, most);
}`;
const FRAGMENT = `
varying vec3 vTint;
void main() { gl_FragColor = vec4(vTint, 1.0); }`;

/** Edge length of a drawn point of a shape, meters: less than a voxel, so that it can be told from the next. */
export const VOXEL_M = 0.14;
/** Brightness of the lowest points of a shape. */
const DARKEST = 0.5;

/** A path is broken where two captures lie farther apart in meters or seconds. */
const GAP_METERS = 30;
const GAP_SECONDS = 120;

export class MapLayer {
  readonly group = new Group();
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  readonly paths: LineSegments;
  private readonly pathRobots: number[];
  /** Middle of the map; GPU coordinates are relative to it, for they have 24 bits only. */
  readonly middle: Vector3;
  readonly low: Vector3;
  readonly high: Vector3;
  /** Row of each drawn point: a fixed shuffle, so that any first part is a sample of the whole. */
  private readonly rows: Uint32Array;
  private readonly tints: BufferAttribute;
  /** Decoded shapes of some segments; none are there before they are asked for. */
  readonly shapes: Points<BufferGeometry, ShaderMaterial>;
  /** Row of each point of `shapes`. */
  private shapeRows = new Uint32Array();
  /** Brightness of each point of `shapes`: the foot of a shape is darker than its top. */
  private shades = new Float32Array();
  /** Color of each row, three bytes. */
  private colors: Uint8Array;

  constructor(readonly content: MapContent) {
    const { centroids, ids } = content;
    this.low = new Vector3(Infinity, Infinity, Infinity);
    this.high = new Vector3(-Infinity, -Infinity, -Infinity);
    const corner = new Vector3();
    for (let row = 0; row < ids.length; row += 1) {
      corner.fromArray(centroids, 3 * row);
      this.low.min(corner);
      this.high.max(corner);
    }
    if (!ids.length) {
      this.low.set(-10, -10, -1);
      this.high.set(10, 10, 1);
    }
    this.middle = this.low.clone().add(this.high).multiplyScalar(0.5);
    this.rows = shuffled(ids.length);
    const positions = new Float32Array(3 * ids.length);
    this.rows.forEach((row, place) => {
      positions[3 * place] = centroids[3 * row]! - this.middle.x;
      positions[3 * place + 1] = centroids[3 * row + 1]! - this.middle.y;
      positions[3 * place + 2] = centroids[3 * row + 2]! - this.middle.z;
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    this.tints = new BufferAttribute(new Uint8Array(3 * ids.length), 3, true);
    geometry.setAttribute("tint", this.tints);
    this.points = new Points(geometry, dots(ids.length < 50_000 ? 2.5 : 1.5, 12));
    this.colors = new Uint8Array(3 * ids.length);
    this.shapes = new Points(new BufferGeometry(), dots(1, 40));
    this.shapes.visible = false;
    for (const each of [this.points, this.shapes]) each.frustumCulled = false;
    [this.paths, this.pathRobots] = pathsOf(content, this.middle);
    this.group.add(this.points, this.shapes, this.paths);
    this.group.matrixAutoUpdate = false;
    this.place(new Matrix4());
  }

  /** Place the map's frame in the scene. */
  place(pose: Matrix4): void {
    this.group.matrix.copy(pose).multiply(new Matrix4().makeTranslation(this.middle));
    this.group.matrixWorldNeedsUpdate = true;
  }

  /** Transform from the map's frame to the scene. */
  get pose(): Matrix4 {
    return this.group.matrix.clone().multiply(new Matrix4().makeTranslation(this.middle.clone().negate()));
  }

  /** Row of the segment with an id; undefined if there is none. */
  rowOf(id: number): number | undefined {
    return rowOf(this.content.ids, id);
  }

  /** Position of a segment in the scene. */
  position(row: number): Vector3 {
    return new Vector3().fromArray(this.content.centroids, 3 * row).applyMatrix4(this.pose);
  }

  /** Color the paths by robot. */
  colorPaths(colorOf: (robot: string) => Color): void {
    const tints = this.paths.geometry.getAttribute("color");
    this.pathRobots.forEach((robot, place) => tints.setXYZ(place, ...colorOf(this.content.robots[robot] ?? "")));
    tints.needsUpdate = true;
  }

  setColors(colors: Uint8Array): void {
    this.colors = colors;
    this.colorShapes();
    const array = this.tints.array as Uint8Array;
    this.rows.forEach((row, place) => {
      array[3 * place] = colors[3 * row]!;
      array[3 * place + 1] = colors[3 * row + 1]!;
      array[3 * place + 2] = colors[3 * row + 2]!;
    });
    this.tints.needsUpdate = true;
  }

  /** Draw the shapes of some rows, in the colors of their segments. Points are relative to the centroid. */
  drawShapes(shapes: { row: number; points: Float32Array }[]): void {
    const count = shapes.reduce((sum, each) => sum + each.points.length / 3, 0);
    this.shapes.geometry.dispose();
    this.shapes.geometry = new BufferGeometry();
    this.shapes.visible = count > 0;
    this.shapeRows = new Uint32Array(count);
    this.shades = new Float32Array(count);
    if (!count) return;
    const places = new Float32Array(3 * count);
    let place = 0;
    for (const { row, points } of shapes) {
      const offset = [0, 1, 2].map((axis) => this.content.centroids[3 * row + axis]! - this.middle.getComponent(axis));
      let [low, high] = [Infinity, -Infinity];
      for (let at = 2; at < points.length; at += 3) [low, high] = [Math.min(low, points[at]!), Math.max(high, points[at]!)];
      for (let at = 0; at < points.length; at += 3, place += 1) {
        this.shapeRows[place] = row;
        this.shades[place] = DARKEST + (1 - DARKEST) * (points[at + 2]! - low) / Math.max(high - low, VOXEL_M);
        for (let axis = 0; axis < 3; axis += 1) places[3 * place + axis] = points[at + axis]! + offset[axis]!;
      }
    }
    this.shapes.geometry.setAttribute("position", new BufferAttribute(places, 3));
    this.shapes.geometry.setAttribute("tint", new BufferAttribute(new Uint8Array(3 * count), 3, true));
    this.colorShapes();
  }

  private colorShapes(): void {
    if (!this.shapeRows.length) return;
    const tints = this.shapes.geometry.getAttribute("tint");
    const array = tints.array as Uint8Array;
    this.shapeRows.forEach((row, place) => {
      for (let axis = 0; axis < 3; axis += 1) array[3 * place + axis] = this.shades[place]! * this.colors[3 * row + axis]!;
    });
    tints.needsUpdate = true;
  }

  /**
   * Return the rows in the picture that are nearest to a place of the scene, each with its horizontal
   * distance in meters, and how many segments are in the picture.
   */
  nearest(
    camera: PerspectiveCamera | OrthographicCamera, target: Vector3, most: number,
  ): { rows: [number, number][]; inView: number } {
    const all = new Matrix4()
      .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
      .multiply(this.group.matrix).elements;
    const middle = target.clone().applyMatrix4(this.group.matrix.clone().invert());
    const at = this.points.geometry.getAttribute("position").array;
    let rows: [number, number][] = [];
    let inView = 0;
    let farthest = Infinity;
    const keep = (): void => {
      rows = rows.sort((a, b) => a[1] - b[1]).slice(0, most);
      if (rows.length === most) farthest = rows[most - 1]![1];
    };
    for (let place = 0; place < this.rows.length; place += 1) {
      const [px, py, pz] = [at[3 * place]!, at[3 * place + 1]!, at[3 * place + 2]!];
      const w = all[3]! * px + all[7]! * py + all[11]! * pz + all[15]!;
      if (w <= 0) continue;
      if (Math.abs(all[0]! * px + all[4]! * py + all[8]! * pz + all[12]!) > w) continue;
      if (Math.abs(all[1]! * px + all[5]! * py + all[9]! * pz + all[13]!) > w) continue;
      inView += 1;
      const away = Math.hypot(px - middle.x, py - middle.y);
      if (away >= farthest) continue;
      rows.push([this.rows[place]!, away]);
      if (rows.length >= 4 * most) keep();
    }
    keep();
    return { rows, inView };
  }

  /** Draw at most so many points. */
  limit(count: number): number {
    const drawn = Math.min(count, this.rows.length);
    this.points.geometry.setDrawRange(0, drawn);
    return drawn;
  }

  /** Row of the segment nearest to a point of the screen, by its point or its shape, within so many pixels; -1 if none. */
  pick(
    camera: PerspectiveCamera | OrthographicCamera, x: number, y: number, width: number, height: number,
    pixels: number,
  ): { row: number; distance: number; depth: number } {
    const all = new Matrix4()
      .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
      .multiply(this.group.matrix).elements;
    const found = { row: -1, distance: pixels, depth: Infinity };
    for (const [drawn, rows] of [[this.points, this.rows], [this.shapes, this.shapeRows]] as const) {
      if (!rows.length) continue;
      const at = drawn.geometry.getAttribute("position").array;
      for (let place = 0; place < rows.length; place += 1) {
        const [px, py, pz] = [at[3 * place]!, at[3 * place + 1]!, at[3 * place + 2]!];
        const w = all[3]! * px + all[7]! * py + all[11]! * pz + all[15]!;
        if (w <= 0) continue;
        const sx = ((all[0]! * px + all[4]! * py + all[8]! * pz + all[12]!) / w + 1) * 0.5 * width;
        const sy = (1 - (all[1]! * px + all[5]! * py + all[9]! * pz + all[13]!) / w) * 0.5 * height;
        const distance = Math.hypot(sx - x, sy - y);
        if (distance > pixels) continue;
        if (distance < found.distance - 1 || (distance < found.distance + 1 && w < found.depth)) {
          found.row = rows[place]!;
          found.distance = distance;
          found.depth = w;
        }
      }
    }
    return found;
  }

  dispose(): void {
    for (const each of [this.points, this.shapes, this.paths]) {
      each.geometry.dispose();
      (each.material as ShaderMaterial).dispose();
    }
  }
}

/** Material of square points, whose edges have so many pixels at least and at most. */
function dots(least: number, most: number): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT,
    uniforms: { size: { value: 2 }, perspective: { value: 0 }, least: { value: least }, most: { value: most } },
  });
}

/** A permutation of 0 to count - 1 that is the same each time. */
export function shuffled(count: number): Uint32Array {
  const order = new Uint32Array(count);
  let state = 0x9e3779b9;
  for (let place = 0; place < count; place += 1) {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    const other = (state >>> 0) % (place + 1);
    order[place] = order[other]!;
    order[other] = place;
  }
  return order;
}

function pathsOf(map: MapContent, middle: Vector3): [LineSegments, number[]] {
  const robotOf = new Int32Array(map.frameTimes.length).fill(-1);
  for (let row = 0; row < map.ids.length; row += 1) robotOf[map.frameIndex[row]!] = map.robot[row]!;
  const last = new Map<number, number>();
  const places: number[] = [];
  const robots: number[] = [];
  robotOf.forEach((robot, frame) => {
    const before = last.get(robot);
    last.set(robot, frame);
    if (robot < 0 || before === undefined) return;
    const step = [0, 1, 2].map((axis) => map.framePositions[3 * frame + axis]! - map.framePositions[3 * before + axis]!);
    const far = Math.hypot(...step) > GAP_METERS || map.frameTimes[frame]! - map.frameTimes[before]! > GAP_SECONDS;
    if (far) return;
    for (const end of [before, frame]) {
      places.push(
        map.framePositions[3 * end]! - middle.x, map.framePositions[3 * end + 1]! - middle.y,
        map.framePositions[3 * end + 2]! - middle.z,
      );
      robots.push(robot);
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(places.length), 3));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true }));
  lines.frustumCulled = false;
  return [lines, robots];
}
