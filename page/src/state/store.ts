// What the page knows and shows. Views read these signals; actions change them.
import { computed, effect, signal, untracked } from "@preact/signals";
import { api, ApiError, storeKey, storedKey } from "../api/client";
import { follow, type ServiceEvent } from "../api/events";
import { readMap, type MapContent } from "../api/map_file";
import type { Anchor, KeyInfo, MapDetail, MapList, MapSummary, RobotState, Vector } from "../api/types";
import { CLASSES, colorSegments, type ColorBy, type Legend } from "../scene/coloring";
import { MapLayer } from "../scene/map_layer";
import type { View } from "../scene/scene";
import { Matrix4, Vector3 } from "three";
import { ADDED, css, kindColor, REMOVED, UNCHANGED, type Color } from "../scene/colors";

export type Tab = "maps" | "robots" | "locate" | "service";

export interface Message {
  id: number;
  kind: "error" | "done";
  text: string;
  detail: string;
}

export interface Selection {
  map: string;
  row: number;
}

export const key = signal<KeyInfo | null>(null);
export const needsKey = signal<string | null>(null);
export const version = signal("");
export const list = signal<MapList | null>(null);
export const open = signal<ReadonlyMap<string, MapContent>>(new Map());
export const current = signal<string | null>(null);
export const loading = signal<ReadonlySet<string>>(new Set());
export const selection = signal<Selection | null>(null);
export const colorBy = signal<ColorBy>("robot");
export const legend = signal<Legend[]>([]);
export const hiddenKinds = signal<ReadonlySet<string>>(new Set());
export const matched = signal<ReadonlyMap<string, Map<number, number>>>(new Map());
export const showPaths = signal(true);
export const tab = signal<Tab>("maps");
export const messages = signal<Message[]>([]);
export const robots = signal<RobotState[]>([]);
export const trails = signal<ReadonlyMap<string, { map: string; places: [number, number, number][] }>>(new Map());
/** Last pose from `/localize` of each robot, with the ids of the segments that agree. */
export const fixes = signal<ReadonlyMap<string, { map: string; position: Vector; inliers: number[] }>>(new Map());
export const events = signal<ServiceEvent[]>([]);
export const connected = signal<{ on: boolean; reason: string }>({ on: false, reason: "" });
export const details = signal<ReadonlyMap<string, MapDetail>>(new Map());
/** Version whose changes the picture shows; its map and the other open ones are gray meanwhile. */
export const changesShown = signal<{ map: string; version: number } | null>(null);
/** Whether the picture has a scan, which it can show without any map. */
export const scanShown = signal(false);
export const above = signal(false);
export const measuring = signal(false);
export const measured = signal<{ from: Selection; meters: number; vertical: number } | null>(null);
/** Counts pictures, so that compass and scale follow the view. */
export const picture = signal(0);

export const currentSummary = computed<MapSummary | null>(
  () => list.value?.maps.find((each) => each.name === current.value) ?? null,
);

/** Names of the robots of the open maps, then of those that report: each has one color everywhere. */
const robotNames = computed(() => {
  const mapped = [...open.value.values()].flatMap((each) => each.robots).sort();
  return [...new Set([...mapped, ...robots.value.map((each) => each.robot).sort()])].join("\n");
});
const robotNumbers = computed(() => new Map(robotNames.value.split("\n").map((name, place) => [name, place])));

export const robotColor = (name: string): Color => kindColor(robotNumbers.value.get(name) ?? 0);

/** Place of the current map on the Earth, if it is known. */
export const anchor = computed<Anchor | null>(() => {
  const found = current.value ? details.value.get(current.value)?.anchor : null;
  return found?.applies ? found : null;
});

let view: View | null = null;
let counter = 0;
let stop = new AbortController();

export const scene = (): View => view!;

export function say(kind: Message["kind"], text: string, detail = ""): void {
  counter += 1;
  const id = counter;
  // What was done before is old news; an error stays until it is closed.
  const kept = messages.value.filter((each) => kind === "error" || each.kind === "error");
  messages.value = [...kept.slice(-3), { id, kind, text, detail }];
  if (kind === "done") setTimeout(() => dismiss(id), 8000);
}

/** Title of the message about a service that does not answer; it goes when the service does. */
const NO_CONNECTION = "No connection";

function isBack(): void {
  if (!connected.value.on) connected.value = { on: true, reason: "" };
  if (messages.value.some((each) => each.text === NO_CONNECTION)) {
    messages.value = messages.value.filter((each) => each.text !== NO_CONNECTION);
  }
}

export function dismiss(id: number): void {
  messages.value = messages.value.filter((each) => each.id !== id);
}

/** Run an action; show its error, and ask for a key where one is needed. */
export async function attempt<Result>(work: () => Promise<Result>): Promise<Result | undefined> {
  try {
    return await work();
  } catch (error) {
    if (error instanceof ApiError && error.status === 401) {
      needsKey.value = storedKey() ? "The service does not know this key." : "";
    } else if (error instanceof ApiError && error.status === 0 && messages.value.some((each) => each.text === error.title)) {
      // One message says it; each further request would say the same.
    } else if (error instanceof ApiError) {
      const wait = error.retryAfter ? ` Try again in ${error.retryAfter} s.` : "";
      say("error", error.title, error.detail + wait);
    } else {
      say("error", "The page failed", error instanceof Error ? error.message : String(error));
    }
    return undefined;
  }
}

/** Whether the key may write a map. A key of one robot may not change whole maps. */
export function mayWrite(map: string): boolean {
  const mine = key.value;
  if (!mine?.may_write || mine.robot !== null) return false;
  return mine.maps.some((pattern) => matches(pattern, map));
}

export const mayWriteAny = computed(() => key.value !== null && key.value.may_write && key.value.robot === null);

export function matches(pattern: string, name: string): boolean {
  const expression = pattern.replace(/[.+^${}()|\\]/g, "\\$&").replace(/\*/g, ".*").replace(/\?/g, ".").replace(/\[!/g, "[^");
  return new RegExp(`^${expression}$`).test(name);
}

export async function start(created: View): Promise<void> {
  view = created;
  view.onFrame = () => (picture.value += 1);
  effect(() => {
    void robotNames.value;
    untracked(recolor);
  });
  await signIn(storedKey());
}

/** Use a key; an empty one for a service without keys. */
export async function signIn(typed: string): Promise<void> {
  storeKey(typed);
  stop.abort();
  stop = new AbortController();
  try {
    const found = await api.key();
    if (found.role === "none") {
      needsKey.value = typed ? "The service does not know this key. Check it, or ask for a new one." : "";
      return;
    }
    key.value = found;
    needsKey.value = null;
    version.value = (await api.info()).version;
  } catch (error) {
    await attempt(() => Promise.reject(error as Error));
    setTimeout(() => void signIn(typed), 3000);
    return;
  }
  await refresh();
  const asked = new URLSearchParams(location.hash.slice(1)).get("map");
  const known = list.value?.maps ?? [];
  const first = known.find((each) => each.name === asked) ?? (known.length === 1 ? known[0] : undefined);
  if (first) await openMap(first.name);
  const { signal } = stop;
  void follow(signal, onEvent, (on, reason) => (on ? isBack() : (connected.value = { on, reason })));
  void poll(signal);
}

export function signOut(): void {
  stop.abort();
  storeKey("");
  for (const name of [...open.value.keys()]) closeMap(name);
  [list.value, key.value, robots.value, events.value] = [null, null, [], []];
  needsKey.value = "";
}

async function poll(signal: AbortSignal): Promise<void> {
  while (!signal.aborted) {
    await new Promise((done) => setTimeout(done, 3000));
    if (signal.aborted || document.hidden) continue;
    await refresh(true);
    await refreshRobots();
  }
}

/** Read the list of maps again; open maps that have changed are read again. */
export async function refresh(quiet = false): Promise<void> {
  try {
    list.value = await api.maps();
    isBack();
  } catch (error) {
    if (quiet) {
      connected.value = { on: false, reason: error instanceof Error ? error.message : "" };
      return;
    }
    await attempt(() => Promise.reject(error as Error));
    return;
  }
  for (const [name, content] of open.value) {
    const now = list.value.maps.find((each) => each.name === name);
    if (!now) closeMap(name);
    else if (now.etag !== content.etag && !loading.value.has(name)) await openMap(name, false);
  }
}

let robotsKnown = true;

async function refreshRobots(): Promise<void> {
  if (!robotsKnown) return;
  try {
    robots.value = await api.robots();
  } catch (error) {
    if (error instanceof ApiError && error.status === 404) robotsKnown = false;
  }
  extendTrails();
}

function extendTrails(): void {
  const next = new Map(trails.value);
  for (const robot of robots.value) {
    if (!robot.map || !robot.position) continue;
    const before = next.get(robot.robot);
    const places = before?.map === robot.map ? before.places : [];
    const last = places.at(-1);
    const moved = !last || Math.hypot(...last.map((value, axis) => value - robot.position![axis]!)) > 0.2;
    if (moved) next.set(robot.robot, { map: robot.map, places: [...places.slice(-999), robot.position] });
  }
  trails.value = next;
}

const lastStates = new Map<string, string>();

function onEvent(event: ServiceEvent): void {
  const { data } = event;
  // Robots report each second. The list of events has what is new in a report: another state.
  const robot = String(data["robot"] ?? "");
  const state = `${String(data["state"])} ${String(data["map"])}`;
  if (event.kind !== "robot" || lastStates.get(robot) !== state) {
    events.value = [{ ...event, data: { ...data, received: Date.now() / 1000 } }, ...events.value].slice(0, 100);
  }
  if (event.kind === "robot") lastStates.set(robot, state);
  if (["upload", "merge", "write"].includes(event.kind)) void refresh(true);
  if (event.kind === "fix" && Array.isArray(data["inliers"])) {
    const who = String(data["robot"] ?? data["session"] ?? "");
    fixes.value = new Map([...fixes.value, [who, {
      map: String(data["map"]), position: data["position"] as Vector, inliers: data["inliers"] as number[],
    }]]);
  }
  if (event.kind === "no-fix") {
    const who = String(data["robot"] ?? data["session"] ?? "");
    fixes.value = new Map([...fixes.value].filter(([name]) => name !== who));
  }
  if (["fix", "no-fix", "robot"].includes(event.kind)) refreshRobotsSoon();
  if (event.kind === "alarm" && data["raised"] === true) say("error", `Alarm: ${String(data["alarm"])}`, String(data["detail"] ?? ""));
}

let robotsDue = false;

/** Several robots may report at once; one request is enough for all. */
function refreshRobotsSoon(): void {
  if (robotsDue) return;
  robotsDue = true;
  setTimeout(() => {
    robotsDue = false;
    void refreshRobots();
  }, 300);
}

/** Read a map and show it. */
export async function openMap(name: string, look = true): Promise<void> {
  loading.value = new Set([...loading.value, name]);
  const content = await attempt(() => readMap(name));
  loading.value = new Set([...loading.value].filter((each) => each !== name));
  if (!content) return;
  const before = scene().layers.get(name)?.pose;
  const layer = new MapLayer(content);
  const place = before ?? beside(layer);
  scene().add(layer);
  layer.place(place);
  open.value = new Map([...open.value, [name, content]]);
  if (look || !current.value) current.value = name;
  if (selection.value?.map === name) select(null);
  recolor();
  if (look) {
    scene().fit(name);
    location.hash = new URLSearchParams({ map: name }).toString();
  }
  const detail = await attempt(() => api.map(name));
  if (detail) details.value = new Map([...details.value, [name, detail]]);
}

/** Maps of one frame lie on each other. A map of another frame lies beside, until it is aligned. */
function beside(layer: MapLayer): Matrix4 {
  const corner = new Vector3(-Infinity, 0, 0);
  for (const other of scene().layers.values()) {
    if (other.content.name === layer.content.name) continue;
    if (other.content.frame === layer.content.frame) return other.pose;
    const low = other.low.clone().applyMatrix4(other.pose);
    const high = other.high.clone().applyMatrix4(other.pose);
    corner.set(Math.max(corner.x, low.x + 30, high.x + 30), low.y, low.z);
  }
  return corner.x === -Infinity ? new Matrix4() : new Matrix4().makeTranslation(corner.sub(layer.low));
}

export function closeMap(name: string): void {
  scene().remove(name);
  open.value = new Map([...open.value].filter(([each]) => each !== name));
  if (current.value === name) current.value = [...open.value.keys()].at(-1) ?? null;
  if (selection.value?.map === name) select(null);
  recolor();
}

export function recolor(): void {
  const seen = new Map<string, Legend>();
  const contents = [...open.value.values()];
  const number = (names: string[]): ((name: string) => number) => {
    const index = new Map([...new Set(names)].sort().map((name, place) => [name, place]));
    return (name) => index.get(name) ?? 0;
  };
  const robotIndex = (name: string): number => robotNumbers.value.get(name) ?? 0;
  if (changesShown.value) {
    for (const layer of scene().layers.values()) {
      layer.setColors(new Uint8Array(3 * layer.content.ids.length).map((_, place) => 255 * UNCHANGED[place % 3]!));
      layer.paths.visible = false;
    }
    legend.value = [
      { color: css(ADDED), label: `added or replaced in version ${changesShown.value.version}` },
      { color: css(REMOVED), label: `removed in version ${changesShown.value.version}` },
      { color: css(UNCHANGED), label: "not changed" },
    ];
    scene().redraw();
    return;
  }
  const kinds: Partial<Record<ColorBy, (name: string) => number>> = {
    robot: robotIndex, origin: number(contents.flatMap((each) => [each.name, ...each.sources])),
  };
  open.value.forEach((content, name) => {
    const { colors, legend: parts } = colorSegments(
      content, colorBy.value, kinds[colorBy.value] ?? ((kind) => CLASSES.indexOf(kind)), matched.value.get(name) ?? new Map(), new Set(hiddenKinds.value),
    );
    const layer = scene().layers.get(name);
    layer?.setColors(colors);
    if (layer) layer.paths.visible = showPaths.value;
    layer?.colorPaths(robotColor);
    for (const part of parts) seen.set(part.label, part);
  });
  legend.value = [...seen.values()];
  scene().redraw();
}

export function select(chosen: Selection | null): void {
  const before = selection.value;
  selection.value = chosen;
  scene().overlay("alike", []);
  if (!chosen) {
    scene().mark(null);
    return;
  }
  const layer = scene().layers.get(chosen.map);
  if (!layer) return;
  const place = layer.position(chosen.row);
  const { extents } = layer.content;
  const size = extents ? Math.max(0.5, ...[0, 1, 2].map((axis) => extents[3 * chosen.row + axis]! / 20)) : 1;
  scene().mark(place, size);
  const other = before && scene().layers.get(before.map);
  if (measuring.value && before && other) {
    const from = other.position(before.row);
    measured.value = { from: before, meters: place.distanceTo(from), vertical: place.z - from.z };
    scene().overlay("measure", [{ from, to: place, color: [1, 1, 1] }]);
  } else {
    measured.value = null;
    scene().overlay("measure", []);
  }
}

/**
 * Select the segment with an id: in the current map, and when asked again in the next open map that
 * has it. Return the names of the maps that have it, the selected one first.
 */
export function selectId(id: number): string[] {
  const names = [...scene().layers.keys()].sort((a, b) => Number(b === current.value) - Number(a === current.value));
  const having = names.filter((name) => scene().layers.get(name)!.rowOf(id) !== undefined);
  const chosen = selection.value;
  const before = chosen ? having.findIndex((name) => name === chosen.map && scene().layers.get(name)!.rowOf(id) === chosen.row) : -1;
  const order = [...having.slice(before + 1), ...having.slice(0, before + 1)];
  const layer = order[0] === undefined ? undefined : scene().layers.get(order[0]);
  if (!layer) return [];
  const row = layer.rowOf(id)!;
  select({ map: layer.content.name, row });
  scene().look(layer.position(row), Math.min(scene().reach(), 30));
  return order;
}
