// Show what an optimization of a map would move, write it, and undo it.
import { signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { Vector3 } from "three";
import { api } from "../api/client";
import type { MapSummary, Optimized } from "../api/types";
import { ADDED, css, FIX, GRAY, REMOVED, type Color } from "../scene/colors";
import type { Line } from "../scene/scene";
import { attempt, list, open, refresh, say, scene } from "../state/store";
import { Button, count, Dialog, meters } from "./parts";
import { Swatch } from "./stage";

/** The last optimization that was written, until it is undone. */
const lastOptimization = signal<Optimized | null>(null);

const REASONS: Record<string, string> = {
  "not-explained-by-drift": "the odometry cannot have drifted so far",
  unsupported: "no other loops agree",
  inconsistent: "contradicts other loops",
  outlier: "does not fit the optimized poses",
};

const MEANINGS: [Color, string][] = [
  [GRAY, "capture now"], [FIX, "where it would move"], [ADDED, "accepted loop"], [REMOVED, "rejected loop"],
];

export function Optimize(props: { map: MapSummary }) {
  const { map } = props;
  const [busy, setBusy] = useState("");
  const [preview, setPreview] = useState<Optimized | null>(null);
  const [asked, setAsked] = useState(false);
  // Another version of the map has other loops.
  useEffect(() => () => hide(), [map.etag]);
  useEffect(() => { setPreview(null); setAsked(false); }, [map.etag]);

  const look = async (): Promise<void> => {
    setBusy("Looking for loops. This takes some seconds for each kilometer. Nothing is written.");
    setPreview(null);
    hide();
    const answer = await attempt(() => api.optimize(map.name, map.etag, true));
    setBusy("");
    if (!answer) return;
    setPreview(answer);
    draw(map.name, answer);
  };
  const write = async (): Promise<void> => {
    setAsked(false);
    setBusy("Moving the captures.");
    const answer = await attempt(() => api.optimize(map.name, map.etag, false));
    setBusy("");
    if (!answer) return;
    if (answer.sequence === null) {
      say("done", `${map.name} stays as it is`, "No capture has to move.");
      return;
    }
    lastOptimization.value = answer;
    say("done", `The drift of ${map.name} is removed`, `${count(answer.changed)} segments moved.`);
    await refresh();
  };
  return (
    <>
      <p>A place that a robot has visited twice closes a loop. Loops show how far the odometry has drifted, and the map is bent so that they fit.</p>
      <div class="row">
        <Button kind="main" disabled={busy !== ""} onClick={() => void look()}>Look for loops</Button>
      </div>
      {busy && <p role="status">{busy}</p>}
      {preview && (
        <div role="status">
          <p>{summaryOf(preview)}</p>
          {preview.parts.length > 1 && (
            <>
              <p>Nothing connects these parts of the map. Each keeps its place relative to the others:</p>
              <ul>{preview.parts.slice(0, 8).map((part, index) => <li key={index}>{part.robots.join(", ")}: {count(part.captures)} captures, moved at most {meters(part.moved_m)}</li>)}</ul>
            </>
          )}
          {rejectedOf(preview).length > 0 && (
            <>
              <p>Rejected loops:</p>
              <ul>{rejectedOf(preview).map(([reason, number]) => <li key={reason}>{count(number)}: {REASONS[reason] ?? reason}</li>)}</ul>
            </>
          )}
          <ul aria-label="Colors of the preview">
            {MEANINGS.map(([color, meaning]) => <li key={meaning}><Swatch color={css(color)} />{meaning}</li>)}
          </ul>
          {preview.moved_max_m > 0
            ? <Button disabled={busy !== ""} onClick={() => setAsked(true)}>Remove the drift</Button>
            : <p>There is nothing to move.</p>}
        </div>
      )}
      {asked && preview && (
        <Dialog title={`Remove the drift of ${map.name}?`} onClose={() => setAsked(false)}>
          <p>{count(preview.captures)} captures move by {meters(preview.moved_median_m)} in the median and {meters(preview.moved_max_m)} at most. Their segments move with them.</p>
          <p>The result is a new version. You can undo it.</p>
          <div class="row">
            <Button kind="main" onClick={() => void write()}>Remove the drift</Button>
            <Button onClick={() => setAsked(false)}>Cancel</Button>
          </div>
        </Dialog>
      )}
    </>
  );
}

/** Offers to undo the last optimization, as long as its version is the newest of the map. */
export function UndoOptimization() {
  const done = lastOptimization.value;
  const now = list.value?.maps.find((each) => each.name === done?.map);
  if (!done || now?.etag !== done.etag) return null;
  const undo = async (): Promise<void> => {
    if (!(await attempt(() => api.restore(done.map, done.previous, done.etag!)))) return;
    lastOptimization.value = null;
    say("done", `The optimization of ${done.map} is undone`, `${done.map} is as it was in version ${done.previous}.`);
    await refresh();
  };
  return (
    <div class="row answer good" role="status">
      <span class="grow">The captures of {done.map} have moved by {meters(done.moved_max_m)} at most.</span>
      <Button kind="danger" onClick={() => void undo()}>Undo the optimization</Button>
    </div>
  );
}

function summaryOf(found: Optimized): string {
  if (!found.loops_found) return "No place was visited twice, or the service does not recognize one. Nothing moves.";
  const fit = found.loops_accepted
    ? ` They are ${meters(found.residual_before_m)} off now and would be ${meters(found.residual_after_m)} off. The captures would move by ${meters(found.moved_median_m)} in the median and ${meters(found.moved_max_m)} at most.`
    : "";
  return `${count(found.loops_accepted)} of ${count(found.loops_found)} loops are accepted.${fit}`;
}

/** The reasons of rejected loops, with their numbers. */
function rejectedOf(found: Optimized): [string, number][] {
  const numbers = new Map<string, number>();
  for (const { verdict } of found.loops) if (verdict !== "accepted") numbers.set(verdict, (numbers.get(verdict) ?? 0) + 1);
  return [...numbers];
}

function draw(name: string, found: Optimized): void {
  const layer = open.value.has(name) ? scene().layers.get(name) : undefined;
  if (!layer) return;
  const placed = (position: readonly [number, number, number]): Vector3 => new Vector3(...position).applyMatrix4(layer.pose);
  const moves: Line[] = found.frames.map(({ before, after }) => ({ from: placed(before), to: placed(after), color: FIX }));
  const loops: Line[] = found.loops.map(({ positions: [from, to], verdict }) => ({
    from: placed(from), to: placed(to), color: verdict === "accepted" ? ADDED : REMOVED,
  }));
  const before = found.frames.map((frame) => placed(frame.before));
  const after = found.frames.map((frame) => placed(frame.after));
  scene().overlay("optimization", [...moves, ...loops], [
    { points: before, colors: before.map(() => GRAY), size: 4 }, { points: after, colors: after.map(() => FIX), size: 4 },
  ]);
}

function hide(): void {
  scene().overlay("optimization", []);
}
