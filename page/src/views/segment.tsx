// The selected segment: what is stored of it, and which segments are most like it.
import { signal } from "@preact/signals";
import { api } from "../api/client";
import { readCodes, timeOf, type MapContent } from "../api/map_file";
import type { Candidate } from "../api/types";
import { FIX } from "../scene/colors";
import { classWords, moment } from "../scene/coloring";
import { attempt, colorBy, matched, open, recolor, scene, select, selection, type Selection } from "../state/store";
import { Button, count, percent } from "./parts";

const nearest = signal<{ of: Selection; candidates: Candidate[] } | null>(null);

export function SegmentCard() {
  const chosen = selection.value!;
  const map = open.value.get(chosen.map);
  if (!map) return null;
  const { row } = chosen;
  const found = nearest.value?.of === chosen ? nearest.value.candidates : null;
  const place = [0, 1, 2].map((axis) => map.centroids[3 * row + axis]!.toFixed(2)).join(", ");
  const facts: [string, string][] = [
    ["Map", map.name], ["Robot", map.robots[map.robot[row]!] ?? ""], ["Position", `${place} m`],
    ["Captured", moment(timeOf(map, row))],
  ];
  if (map.seen) facts.push(["Last seen", moment(map.seen[row]!)]);
  if (map.extents) {
    const sides = [0, 1, 2].map((axis) => map.extents![3 * row + axis]! / 10);
    facts.push(["Size", sides.some(Boolean) ? `${sides.map((side) => side.toFixed(1)).join(" × ")} m` : "unknown"]);
  }
  if (map.points) facts.push(["Points", count(map.points[row]!)]);
  if (map.classes) facts.push(["Class", classWords(map.classes[row]!)]);
  if (map.source) facts.push(["From map", map.sources[map.source[row]! - 1] ?? map.name]);
  if (map.views && map.views[row] !== map.ids[row]) facts.push(["Same object as", String(map.views[row])]);
  return (
    <aside class="card" aria-label="Selected segment">
      <header>
        <h2>Segment {map.ids[row]}</h2>
        <Button kind="plain" onClick={() => select(null)} title="Key: Escape">Close</Button>
      </header>
      <dl>{facts.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}</dl>
      <Button onClick={() => void findAlike(map, chosen)}>Find alike segments</Button>
      {found && found.length > 0 && <p class="facts">Probability that it is the same object:</p>}
      {found && (found.length ? (
        <ol class="alike">
          {found.map((each) => (
            <li key={`${each.map} ${each.id}`}>
              <button type="button" class="plain" disabled={!open.value.has(each.map)} onClick={() => go(each)}>
                {each.map} {each.id}
              </button>{" "}
              {each.probability === null ? `distance ${each.distance.toFixed(2)}` : percent(each.probability)}
            </li>
          ))}
        </ol>
      ) : <p>No other segment is near.</p>)}
    </aside>
  );
}

function go(candidate: Candidate): void {
  const row = scene().layers.get(candidate.map)?.rowOf(candidate.id);
  if (row !== undefined) select({ map: candidate.map, row });
}

async function findAlike(map: MapContent, chosen: Selection): Promise<void> {
  const answer = await attempt(async () =>
    api.match({ model_id: map.modelId, codes: [await readCodes(map, chosen.row)], k: 13, rerank: false }));
  const first = answer?.queries[0];
  if (!first || !("candidates" in first)) return;
  const own = map.ids[chosen.row];
  const others = first.candidates.filter((each) => each.map !== map.name || each.id !== own).slice(0, 12)
    .sort((a, b) => (b.probability ?? 0) - (a.probability ?? 0));
  nearest.value = { of: chosen, candidates: others };
  const quality = new Map<string, Map<number, number>>();
  const from = scene().layers.get(map.name)!.position(chosen.row);
  const lines = [];
  for (const each of others) {
    if (!quality.has(each.map)) quality.set(each.map, new Map());
    quality.get(each.map)!.set(each.id, each.probability ?? 0);
    const layer = scene().layers.get(each.map);
    const row = layer?.rowOf(each.id);
    if (layer && row !== undefined) lines.push({ from, to: layer.position(row), color: FIX });
  }
  matched.value = quality;
  scene().overlay("alike", lines);
  if (colorBy.value === "match") recolor();
}
