// Columns of a map file (docs/reference/map-file.md), read by ranges: the codes, which are two
// thirds of the file, stay on the service until a segment is asked for.
import { api, ApiError } from "./client";

type Numbers = Float64Array | Float32Array | Uint32Array | Uint16Array | Uint8Array | Int16Array | Int8Array;

interface Column {
  dtype: string;
  shape: number[];
  data_offsets: [number, number];
}

/** Segments of one version of a map, in the order of the file. Positions are meters. */
export interface MapContent {
  name: string;
  etag: string;
  frame: string;
  modelId: string;
  ids: Uint32Array;
  /** x, y, z of each segment in the map's frame. */
  centroids: Float64Array;
  robots: string[];
  robot: Numbers;
  sources: string[];
  source: Numbers | null;
  seen: Numbers | null;
  views: Numbers | null;
  points: Numbers | null;
  extents: Numbers | null;
  classes: Numbers | null;
  frameIndex: Numbers;
  frameTimes: Float64Array;
  framePositions: Float64Array;
  /** Where each segment's codes lie in the file. */
  codes: { begin: number; bytes: number };
}

const MAKERS: Record<string, { bytes: number; make: (buffer: ArrayBuffer) => Numbers }> = {
  F64: { bytes: 8, make: (buffer) => new Float64Array(buffer) },
  F32: { bytes: 4, make: (buffer) => new Float32Array(buffer) },
  U32: { bytes: 4, make: (buffer) => new Uint32Array(buffer) },
  U16: { bytes: 2, make: (buffer) => new Uint16Array(buffer) },
  U8: { bytes: 1, make: (buffer) => new Uint8Array(buffer) },
  I16: { bytes: 2, make: (buffer) => new Int16Array(buffer) },
  I8: { bytes: 1, make: (buffer) => new Int8Array(buffer) },
};

const HEADER_BYTES = 65_536;

interface Piece {
  bytes: ArrayBuffer;
  etag: string;
  whole: boolean;
}

async function piece(
  name: string, first: number, last: number, etag?: string, version?: number,
): Promise<Piece> {
  const headers: Record<string, string> = { Range: `bytes=${first}-${last}` };
  if (etag) headers["If-Range"] = `"${etag}"`;
  const answer = await api.mapFile(name, headers, version);
  return {
    bytes: await answer.arrayBuffer(),
    etag: (answer.headers.get("ETag") ?? "").replaceAll('"', ""),
    whole: answer.status === 200,
  };
}

/** Read what a picture of the map needs, also of an earlier version. A map that changes is read again. */
export async function readMap(name: string, version?: number): Promise<MapContent> {
  for (let attempt = 0; attempt < 5; attempt += 1) {
    const content = await readOnce(name, version);
    if (content) return content;
  }
  throw new ApiError(0, "Map changes", `The map ${name} changes faster than it can be read.`);
}

async function readOnce(name: string, version?: number): Promise<MapContent | null> {
  const head = await piece(name, 0, HEADER_BYTES - 1, undefined, version);
  const length = Number(new DataView(head.bytes).getBigUint64(0, true));
  let file = new Uint8Array(head.bytes);
  if (!head.whole && length + 8 > file.length) {
    const rest = await piece(name, file.length, length + 7, head.etag, version);
    if (rest.whole) return null;
    file = joined(file, new Uint8Array(rest.bytes));
  }
  const outer = JSON.parse(new TextDecoder().decode(file.subarray(8, 8 + length))) as
    Record<string, Column> & { __metadata__: { placecell: string } };
  const body = 8 + length;
  const needed = body + outer["codes"]!.data_offsets[0];
  if (!head.whole && needed > file.length) {
    const rest = await piece(name, file.length, needed - 1, head.etag, version);
    if (rest.whole) return null;
    file = joined(file, new Uint8Array(rest.bytes));
  }
  return contentOf(name, head.etag, file, outer, body);
}

function joined(a: Uint8Array, b: Uint8Array): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(a.length + b.length);
  all.set(a);
  all.set(b, a.length);
  return all;
}

/** Parse the columns of a map or delta file in memory; codes may be missing. */
export function contentOf(
  name: string, etag: string, file: Uint8Array,
  outer: Record<string, Column> & { __metadata__: { placecell: string } }, body: number,
): MapContent {
  const inner = JSON.parse(outer.__metadata__.placecell) as {
    frame: string; model_id: string; robots: string[]; sources?: string[];
  };
  const optional = (column: string): Numbers | null => {
    const found = outer[column];
    if (!found) return null;
    const maker = MAKERS[found.dtype];
    if (!maker) throw new ApiError(0, "Unknown column", `Column ${column} has type ${found.dtype}.`);
    const [begin, end] = found.data_offsets;
    return maker.make(file.slice(body + begin, body + end).buffer as ArrayBuffer);
  };
  const column = <Type extends Numbers>(wanted: string): Type => optional(wanted) as Type;
  const framePositions = column<Float64Array>("frame_positions");
  const frameIndex = column<Uint16Array | Uint32Array>("frame_index");
  const steps = column<Int16Array>("centroids");
  const ids = column<Uint32Array>("ids");
  const centroids = new Float64Array(steps.length);
  for (let segment = 0; segment < ids.length; segment += 1) {
    const frame = 3 * frameIndex[segment]!;
    for (let axis = 0; axis < 3; axis += 1) {
      const sensor = Math.round(100 * framePositions[frame + axis]!);
      centroids[3 * segment + axis] = (sensor + steps[3 * segment + axis]!) / 100;
    }
  }
  const codes = outer["codes"]!;
  return {
    name, etag, frame: inner.frame, modelId: inner.model_id, ids, centroids,
    robots: inner.robots, robot: column("robot"),
    sources: inner.sources ?? [], source: optional("source"), seen: optional("seen"),
    views: optional("views"), points: optional("points"), extents: optional("extents"),
    classes: optional("classes"), frameIndex, frameTimes: column<Float64Array>("frame_times"),
    framePositions,
    codes: { begin: body + codes.data_offsets[0], bytes: codes.shape[1] ?? 0 },
  };
}

/** Parse a delta file: the segments that it adds or replaces, or all of the map, and the ids that it removes. */
export function parseDelta(name: string, buffer: ArrayBuffer): { changed: MapContent; removed: Uint32Array; whole: boolean } {
  const file = new Uint8Array(buffer);
  const length = Number(new DataView(buffer).getBigUint64(0, true));
  const outer = JSON.parse(new TextDecoder().decode(file.subarray(8, 8 + length))) as
    Record<string, Column> & { __metadata__: { placecell: string } };
  const changed = contentOf(name, "", file, outer, 8 + length);
  const [begin, end] = outer["removed"]!.data_offsets;
  const { since, until } = JSON.parse(outer.__metadata__.placecell) as { since?: number; until?: number };
  return { changed, whole: since === 0 && (until ?? 0) > 0, removed: new Uint32Array(buffer.slice(8 + length + begin, 8 + length + end)) };
}

/** Read the codes of one segment, by its row. */
export async function readCodes(map: MapContent, row: number): Promise<number[]> {
  const first = map.codes.begin + row * map.codes.bytes;
  const found = await piece(map.name, first, first + map.codes.bytes - 1, map.etag);
  if (found.etag !== map.etag) {
    throw new ApiError(412, "Map changed", "The map has changed. Open it again.");
  }
  const bytes = found.whole ? found.bytes.slice(first, first + map.codes.bytes) : found.bytes;
  return [...new Int8Array(bytes)];
}

/** Row of the segment with an id, where ids ascend as in a file; undefined if there is none. */
export function rowOf(ids: Uint32Array, id: number): number | undefined {
  let [low, high] = [0, ids.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ids[middle]! < id) low = middle + 1;
    else high = middle;
  }
  return ids[low] === id ? low : undefined;
}

/** Whether the first bytes of a file are those of a map file. */
export async function isMapFile(file: Blob): Promise<boolean> {
  const start = new Uint8Array(await file.slice(0, 400).arrayBuffer());
  const text = new TextDecoder().decode(start.subarray(8));
  return text.startsWith('{"__metadata__":{"placecell":');
}

export const timeOf = (map: MapContent, row: number): number => map.frameTimes[map.frameIndex[row]!]!;
