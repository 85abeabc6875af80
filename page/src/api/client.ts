// The public HTTP API. Every address is relative to the page, so it holds behind a path prefix.
import type {
  Alignment, KeyInfo, LocalizeAnswer, MapDetail, MapList, MapSummary, MatchAnswer, Merged, Optimized, Pose,
  RobotState, Scan, Shapes, Version, Written,
} from "./types";

const KEY = "placecell-key";

/** Error of the service (RFC 9457), or of the connection. */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    readonly title: string,
    readonly detail: string,
    readonly retryAfter: number | null = null,
  ) {
    super(detail || title);
  }
}

export interface Options {
  method?: string;
  query?: Record<string, string | number | boolean | number[] | undefined>;
  json?: unknown;
  body?: BodyInit;
  headers?: Record<string, string>;
  signal?: AbortSignal;
}

/** The key that the user typed; kept for this tab only. */
export const storedKey = (): string => sessionStorage.getItem(KEY) ?? "";
export const storeKey = (key: string): void => {
  if (key) sessionStorage.setItem(KEY, key);
  else sessionStorage.removeItem(KEY);
};

const pathOf = (...parts: (string | number)[]): string =>
  parts.map((part) => encodeURIComponent(part)).join("/");

/** Send a request; throw an `ApiError` for any answer that is not a success or a 304. */
export async function send(path: string, options: Options = {}): Promise<Response> {
  const address = new URL(path, document.baseURI);
  for (const [name, value] of Object.entries(options.query ?? {})) {
    if (value === undefined) continue;
    for (const each of Array.isArray(value) ? value : [value]) address.searchParams.append(name, String(each));
  }
  const headers: Record<string, string> = { Accept: "application/json", ...options.headers };
  const key = storedKey();
  if (key) headers["Authorization"] = `Bearer ${key}`;
  let body = options.body;
  if (options.json !== undefined) {
    headers["Content-Type"] = "application/json";
    body = JSON.stringify(options.json);
  }
  const request: RequestInit = { method: options.method ?? "GET", headers, cache: "no-store" };
  if (body !== undefined) request.body = body;
  if (options.signal) request.signal = options.signal;
  let answer: Response;
  try {
    answer = await fetch(address, request);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new ApiError(0, "No connection", "The service does not answer. Check that it runs.");
  }
  if (answer.ok || answer.status === 304) return answer;
  throw await problemOf(answer);
}

async function problemOf(answer: Response): Promise<ApiError> {
  const retry = Number(answer.headers.get("Retry-After"));
  const text = await answer.text().catch(() => "");
  try {
    const problem = JSON.parse(text) as { title?: string; detail?: string };
    return new ApiError(
      answer.status, problem.title ?? `Status ${answer.status}`, problem.detail ?? "", retry || null,
    );
  } catch {
    return new ApiError(answer.status, `Status ${answer.status}`, text.slice(0, 300), retry || null);
  }
}

async function json<Result>(path: string, options: Options = {}): Promise<Result> {
  return (await (await send(path, options)).json()) as Result;
}

export const api = {
  key: () => json<KeyInfo>("key"),
  info: () => json<{ version: string; model: { model_id: string } }>("info"),
  metrics: async () => (await send("metrics", { headers: { Accept: "text/plain" } })).text(),
  maps: () => json<MapList>("maps"),
  map: (name: string) => json<MapDetail>(pathOf("maps", name)),
  shapes: (name: string, ids: number[], signal: AbortSignal) =>
    json<Shapes>(pathOf("maps", name, "shapes"), { query: { id: ids }, signal }),
  versions: async (name: string) =>
    (await json<{ versions: Version[] }>(pathOf("maps", name, "versions"))).versions,
  restore: (name: string, version: number, etag: string, dryRun = false) =>
    json<Written>(pathOf("maps", name, "versions", version, "restore"), {
      method: "POST",
      query: { dry_run: dryRun || undefined },
      headers: { "If-Match": `"${etag}"` },
    }),
  versionChanges: async (name: string, version: number) =>
    (await send(pathOf("maps", name, "versions", version, "changes"), {
      headers: { Accept: "*/*" },
    })).arrayBuffer(),
  align: (name: string, other: string) =>
    json<Alignment>(pathOf("maps", name, "align", other), { method: "POST", query: { pairs: true } }),
  merge: (name: string, maps: string[], dryRun: boolean, etag: string | null) =>
    json<Merged>(pathOf("maps", name, "merge"), {
      method: "POST",
      json: { maps, dry_run: dryRun },
      headers: etag ? { "If-Match": `"${etag}"` } : {},
    }),
  optimize: (name: string, etag: string, dryRun: boolean) =>
    json<Optimized>(pathOf("maps", name, "optimize"), {
      method: "POST", query: { dry_run: dryRun || undefined, frames: dryRun || undefined },
      headers: { "If-Match": `"${etag}"` },
    }),
  deleteMap: async (name: string, etag: string) =>
    void (await send(pathOf("maps", name), {
      method: "DELETE", headers: { "If-Match": `"${etag}"` },
    })),
  prune: (name: string, unseenSince: number, dryRun: boolean) =>
    json<Written>(pathOf("maps", name, "age"), {
      method: "POST", query: { unseen_since: unseenSince, dry_run: dryRun },
    }),
  uploadMap: (name: string, file: Blob) =>
    json<MapSummary>(pathOf("maps", name), {
      method: "PUT", body: file,
      headers: { "Content-Type": "application/vnd.placecell.map", "If-None-Match": "*" },
    }),
  /** Add a scan to a map at its pose there; without a pose, make a new map of it. */
  addScan: (name: string, robot: string, file: File, pose: Pose | null) =>
    json<Written>(pathOf("maps", name, "scans"), {
      method: "POST", body: file,
      query: {
        name: file.name, robot,
        ...(pose ? { deduplicate: true, x: pose.translation[0], y: pose.translation[1], z: pose.translation[2], yaw: pose.yaw } : { create: true }),
      },
      headers: { "Content-Type": "application/octet-stream", ...(pose ? {} : { "If-None-Match": "*" }) },
    }),
  scan: (file: File) =>
    json<Scan>("scans", {
      method: "POST", body: file, query: { name: file.name },
      headers: { "Content-Type": "application/octet-stream" },
    }),
  match: (body: unknown) => json<MatchAnswer>("match", { method: "POST", json: body }),
  localize: (body: unknown) => json<LocalizeAnswer>("localize", { method: "POST", json: body }),
  robots: async () => (await json<{ robots: RobotState[] }>("robots")).robots,
  mapFile: (name: string, headers: Record<string, string>, version?: number) =>
    send(pathOf("maps", name), { headers: { Accept: "*/*", ...headers }, query: { version } }),
  exportMap: async (name: string, to: string) =>
    (await send(pathOf("maps", name, "export"), { query: { to }, headers: { Accept: "*/*" } })).blob(),
};
