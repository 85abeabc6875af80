// Shapes of the segments near the middle of the view, which the service decodes from their codes.
import { computed, effect, signal, untracked } from "@preact/signals";
import { api, ApiError } from "../api/client";
import type { MapLayer } from "../scene/map_layer";
import { attempt, colorBy, details, hiddenKinds, open, picture, recolor, scene } from "./store";

/** Largest number of shapes in the picture. */
const MOST = 300;
/** Shapes of one request; the service answers with 100 at most. */
const BATCH = 50;
/** Time without a movement before shapes are asked for, milliseconds. */
const REST_MS = 250;
/** Largest number of shapes that are kept for later views. */
const KEPT = 3000;
/** Requests for one batch, if the service is busy. */
const TRIES = 5;
const WAIT_SECONDS = 2;

interface Wanted {
  layer: MapLayer;
  row: number;
  away: number;
}

export const shapesOn = signal(false);
/** Segments in the view, how many of them are drawn at most, and how many are drawn now. */
export const shapesShown = signal<{ inView: number; chosen: number; drawn: number } | null>(null);

const canDecode = (name: string): boolean => details.value.get(name)?.shapes ?? false;

/** Whether the service can decode the shapes of an open map. */
export const hasShapes = computed(() => [...open.value.keys()].some(canDecode));

/** Points of shapes relative to their centroids, meters, the last used ones last. */
const kept = new Map<string, Float32Array>();

let work = new AbortController();
let [lastMaps, lastView] = ["", ""];

/** Switch the shapes on or off. Shapes of a map with classes are colored by class first. */
export function toggleShapes(): void {
  shapesOn.value = !shapesOn.value;
  const classed = [...open.value.values()].some((each) => each.classes && canDecode(each.name));
  if (!shapesOn.value || !classed || colorBy.value === "class") return;
  colorBy.value = "class";
  hiddenKinds.value = new Set();
  recolor();
}

/** Let the shapes follow the view and the open maps. */
export function watchShapes(): void {
  effect(() => {
    void picture.value;
    const layers = [...open.value].filter(([name]) => canDecode(name));
    const on = shapesOn.value && layers.length > 0;
    untracked(() => follow(on));
  });
}

function follow(on: boolean): void {
  const view = scene();
  const { matrixWorld, projectionMatrix } = view.camera;
  const layers = on ? decodable() : [];
  const maps = layers.map(({ content, group }) => `${content.name} ${content.etag} ${group.matrix.elements.join()}`).join("\n");
  const seen = on ? [...matrixWorld.elements, ...projectionMatrix.elements].join() : "";
  // A picture that the shapes themselves changed asks for nothing.
  if (maps === lastMaps && seen === lastView) return;
  const wait = maps === lastMaps ? REST_MS : 0;
  [lastMaps, lastView] = [maps, seen];
  work.abort();
  work = new AbortController();
  if (!on) {
    for (const layer of view.layers.values()) layer.drawShapes([]);
    shapesShown.value = null;
    view.redraw();
    return;
  }
  const { signal } = work;
  setTimeout(() => void load(signal), wait);
}

const decodable = (): MapLayer[] => [...scene().layers.values()].filter((each) => canDecode(each.content.name));

async function load(signal: AbortSignal): Promise<void> {
  if (signal.aborted) return;
  const view = scene();
  const found = decodable().map((layer) => ({ layer, ...layer.nearest(view.camera, view.target, MOST) }));
  const inView = found.reduce((sum, each) => sum + each.inView, 0);
  const chosen: Wanted[] = found.flatMap(({ layer, rows }) => rows.map(([row, away]) => ({ layer, row, away })));
  chosen.sort((a, b) => a.away - b.away).splice(MOST);
  draw(chosen, inView);
  let missing = chosen.filter((each) => !kept.has(keyOf(each)));
  while (missing.length) {
    const { layer } = missing[0]!;
    const batch = missing.filter((each) => each.layer === layer).slice(0, BATCH);
    if (!(await ask(layer, batch, signal))) return;
    missing = missing.filter((each) => !batch.includes(each));
    draw(chosen, inView);
  }
  // Those that the picture has now were used last, so they are dropped last.
  for (const each of chosen) {
    const points = kept.get(keyOf(each))!;
    kept.delete(keyOf(each));
    kept.set(keyOf(each), points);
  }
  for (const name of kept.keys()) {
    if (kept.size <= KEPT) break;
    kept.delete(name);
  }
}

/** Read the shapes of some segments; return whether the view still wants them. */
async function ask(layer: MapLayer, batch: Wanted[], signal: AbortSignal): Promise<boolean> {
  const { name, ids, centroids } = layer.content;
  for (let tried = 1; ; tried += 1) {
    try {
      const answer = await api.shapes(name, batch.map(({ row }) => ids[row]!), signal);
      if (signal.aborted) return false;
      const shapes = new Map(answer.shapes.map((each) => [each.id, each.points]));
      for (const each of batch) {
        // A segment that the map has no more has no points, until the map is read again.
        const points = shapes.get(ids[each.row]!) ?? [];
        const relative = new Float32Array(3 * points.length);
        points.forEach((point, place) => {
          for (let axis = 0; axis < 3; axis += 1) relative[3 * place + axis] = point[axis]! - centroids[3 * each.row + axis]!;
        });
        kept.set(keyOf(each), relative);
      }
      return true;
    } catch (error) {
      if (signal.aborted) return false;
      const isBusy = error instanceof ApiError && [0, 429, 503, 504].includes(error.status);
      if (!isBusy || tried === TRIES) {
        shapesOn.value = false;
        await attempt(() => Promise.reject(error as Error));
        return false;
      }
      const seconds = error.retryAfter ?? WAIT_SECONDS;
      await new Promise((done) => setTimeout(done, 1000 * seconds));
      if (signal.aborted) return false;
    }
  }
}

/** The code of a segment does not change without its place, so an edit of the map keeps most shapes. */
function keyOf({ layer: { content }, row }: Wanted): string {
  const place = content.centroids.subarray(3 * row, 3 * row + 3).join();
  return `${content.name} ${content.modelId} ${content.ids[row]} ${place}`;
}

function draw(chosen: Wanted[], inView: number): void {
  let drawn = 0;
  for (const layer of scene().layers.values()) {
    const shapes = chosen.filter((each) => each.layer === layer)
      .flatMap((each) => { const points = kept.get(keyOf(each)); return points ? [{ row: each.row, points }] : []; });
    layer.drawShapes(shapes);
    drawn += shapes.length;
  }
  shapesShown.value = { inView, chosen: chosen.length, drawn };
  scene().redraw();
}
