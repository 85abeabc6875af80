// Color of each segment of a map by robot, map of origin, age, class or match quality.
import { timeOf, type MapContent } from "../api/map_file";
import { amountColor, css, GRAY, kindColor, type Color } from "./colors";

export type ColorBy = "robot" | "origin" | "age" | "class" | "match";

export const COLOR_NAMES: Record<ColorBy, string> = {
  robot: "robot", origin: "map of origin", age: "age", class: "class", match: "match quality",
};

export const CLASSES = [
  "unknown", "building", "vegetation", "trunk or pole", "vehicle", "person", "fence or wall", "sign", "other",
];

/** Place in `CLASSES` of the byte that a map stores: 0, or 1 + 31 * class + step of the probability. */
export const classIndex = (byte: number): number => Math.ceil(byte / 31);

/** Class of a segment in words, with its probability. */
export function classWords(byte: number): string {
  const name = CLASSES[classIndex(byte)] ?? "unknown";
  return byte ? `${name} (${Math.round((((byte - 1) % 31) * 100) / 30)}%)` : name;
}

export interface Legend {
  color: string;
  label: string;
}

export interface Coloring {
  colors: Uint8Array;
  legend: Legend[];
}

/** Return three bytes a segment, and the legend. `indexOf` numbers the kinds of all open maps. */
export function colorSegments(
  map: MapContent, by: ColorBy, indexOf: (kind: string) => number, matched: Map<number, number>, hidden: Set<string>,
): Coloring {
  const count = map.ids.length;
  const kinds = (names: string[], kindOf: (row: number) => number): Coloring => {
    const palette = names.map((name) => (hidden.has(name) ? GRAY : kindColor(indexOf(name))));
    return {
      colors: fill(count, (row) => palette[kindOf(row)] ?? GRAY),
      legend: names.map((label, index) => ({ label, color: css(palette[index]!) })),
    };
  };
  if (by === "robot") return kinds(map.robots, (row) => map.robot[row]!);
  if (by === "origin") {
    const { source } = map;
    if (!source) return kinds([map.name], () => 0);
    return kinds([map.name, ...map.sources], (row) => source[row]!);
  }
  if (by === "class" && map.classes) {
    const { classes } = map;
    return kinds(CLASSES, (row) => classIndex(classes[row]!));
  }
  if (by === "age") {
    const time = (row: number): number => Math.max(map.seen ? map.seen[row]! : 0, timeOf(map, row));
    let [first, last] = [Infinity, -Infinity];
    for (let row = 0; row < count; row += 1) {
      first = Math.min(first, time(row));
      last = Math.max(last, time(row));
    }
    const span = Math.max(last - first, 1e-9);
    return {
      colors: fill(count, (row) => amountColor((time(row) - first) / span)),
      legend: count ? [
        { color: css(amountColor(0)), label: `first seen ${moment(first)}` },
        { color: css(amountColor(1)), label: `last seen ${moment(last)}` },
      ] : [],
    };
  }
  return {
    colors: fill(count, (row) => {
      const quality = matched.get(map.ids[row]!);
      return quality === undefined ? GRAY : amountColor(0.35 + 0.65 * quality);
    }),
    legend: [
      { color: css(GRAY), label: by === "class" ? "this map has no classes" : "no match" },
      ...(by === "match" ? [
        { color: css(amountColor(0.35)), label: "match, probability 0" },
        { color: css(amountColor(1)), label: "match, probability 1" },
      ] : []),
    ],
  };
}

function fill(count: number, colorOf: (row: number) => Color): Uint8Array {
  const colors = new Uint8Array(3 * count);
  for (let row = 0; row < count; row += 1) {
    const color = colorOf(row);
    colors[3 * row] = 255 * color[0];
    colors[3 * row + 1] = 255 * color[1];
    colors[3 * row + 2] = 255 * color[2];
  }
  return colors;
}

/** Time of a capture in words; drives without a clock begin near zero. */
export function moment(seconds: number): string {
  if (Math.abs(seconds) < 1e8) return `${seconds.toFixed(1)} s`;
  return new Date(1000 * seconds).toISOString().slice(0, 16).replace("T", " ");
}
