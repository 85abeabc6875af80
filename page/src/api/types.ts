// Answers of the public API, as docs/reference/http-api.md describes them.

export type Vector = [number, number, number];

export interface Pose {
  translation: Vector;
  rotation: [number, number, number, number];
  yaw: number;
}

export interface MapSummary {
  name: string;
  segments: number;
  sequence: number;
  etag: string;
  bytes: number;
  model_id: string;
  frame: string;
  robots: Record<string, number>;
  sources: Record<string, number>;
  time_span: [number, number] | null;
  optional: string[];
  tags: string[];
}

export interface MapDetail extends MapSummary {
  calibration: { state: string; read: number } | null;
  anchor: Anchor | null;
  /** Whether the service can decode the shapes of the segments. */
  shapes: boolean;
}

/** Points of some segments in the map's frame; segments that the map does not have are missing. */
export interface Shapes {
  shapes: { id: number; points: Vector[] }[];
  missing: number[];
}

export interface MapList {
  model_id: string;
  maps: MapSummary[];
  damaged: string[];
}

export interface KeyInfo {
  name: string;
  role: "none" | "read" | "write" | "admin";
  may_write: boolean;
  maps: string[];
  robot: string | null;
  open: boolean;
}

export interface Version {
  sequence: number;
  etag: string;
  time: number;
  author: string;
  operation: string;
  changed: number;
  removed: number;
}

export interface Written {
  map: string;
  sequence: number;
  etag: string;
  segments: number;
  changed: number;
  removed: number;
  repeats: number;
}

export interface Hypothesis {
  pose: Pose;
  score: number;
  agreement: number;
  pairs: number;
}

export interface Pair {
  id: number;
  other_id: number;
  residual: number;
}

export interface Alignment {
  map: string;
  etag: string;
  frame: string;
  other: string;
  other_etag: string;
  other_frame: string;
  aligned: boolean;
  reason: string | null;
  detail: string;
  pose: Pose | null;
  overlap: { of_map: number; of_other: number } | null;
  score: number;
  agreement: number;
  pairs: number;
  inliers: Pair[];
  others: Hypothesis[];
}

export interface Merged {
  map: string;
  frame: string;
  dry_run: boolean;
  sequence: number | null;
  etag: string | null;
  previous: number | null;
  segments: number;
  changed: number;
  removed: number;
  parts: {
    map: string;
    merged: boolean;
    pose: Pose | null;
    added: number;
    known: number;
    repeats: number;
    removed: number;
  }[];
  alignments: {
    map: string;
    other: string;
    aligned: boolean;
    rejected: boolean;
    reason: string | null;
    detail: string;
  }[];
}

/** What an optimization moves, or would move. */
export interface Optimized {
  map: string;
  sequence: number | null;
  etag: string | null;
  previous: number;
  captures: number;
  changed: number;
  loops_found: number;
  loops_accepted: number;
  loops: { positions: [Vector, Vector]; verdict: string }[];
  residual_before_m: number;
  residual_after_m: number;
  moved_median_m: number;
  moved_max_m: number;
  parts: { robots: string[]; captures: number; moved_m: number }[];
  frames: { before: Vector; after: Vector }[];
}

export interface Candidate {
  map: string;
  id: number;
  robot: string;
  distance: number;
  probability: number | null;
  support: number | null;
  centroid: Vector;
}

export interface MatchAnswer {
  queries: ({ candidates: Candidate[] } | { error: { title: string; detail: string } })[];
}

export interface Localization {
  map: string;
  frame: string;
  localized: boolean;
  reason: string | null;
  detail: string;
  advice: string;
  meters_to_drive: number | null;
  places: { map: string; position: Vector; yaw: number; score: number }[];
  probability: number;
  threshold: number;
  pose: Pose | null;
  covariance: number[][] | null;
  inliers: { query: number; id: number; residual: number }[];
  /** Place of another map that fits nearly as well, or better. */
  rival: { map: string } | null;
}

export interface LocalizeAnswer {
  localizations: Localization[];
}

/** Segments of one cloud, as `POST /scans` finds them. */
export interface Scan {
  format: string;
  points: number;
  dropped_points: number;
  segments: { points: Vector[]; centroid: Vector; extents: Vector }[];
  /** Position of the sensor for each segment, in the frame of the points. */
  sensors: Vector[];
  cloud: { points: Vector[]; labels: number[] };
  problems: { what: string; cure: string }[];
}

export interface RobotState {
  robot: string;
  map: string | null;
  position: Vector | null;
  orientation: [number, number, number, number] | null;
  covariance: number[][] | null;
  probability: number | null;
  state: string;
  reason: string;
  age: number;
  /** Seconds since the report of the pose; later reports may have none. */
  pose_age: number | null;
}

export interface Anchor {
  lat: number;
  lon: number;
  height: number;
  yaw_deg: number;
  /** Point of the map that is at this place, meters. */
  position: Vector;
  /** False if the map has another frame now. */
  applies: boolean;
}
