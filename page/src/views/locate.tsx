// Drop a scan: its segments, its matches, and its pose in the maps.
import { signal } from "@preact/signals";
import { Vector3 } from "three";
import { api } from "../api/client";
import type { Localization, Pose, Scan, Vector } from "../api/types";
import { FIX, GRAY, kindColor, type Color } from "../scene/colors";
import { arrow, ellipse, matrixOf, vector, type Line } from "../scene/scene";
import { attempt, current, list, matched, mayWrite, mayWriteAny, open, openMap, recolor, refresh, say, scanShown, scene } from "../state/store";
import { Button, count, degrees, FileButton, meters, percent } from "./parts";
import { useState } from "preact/hooks";

interface Located {
  file: File;
  scan: Scan;
  answers: Localization[] | null;
}

const located = signal<Located | null>(null);
const busy = signal("");
/** Map to search; empty: all. Two maps of one place are rivals: only one of them can be meant. */
const searched = signal("");

function clear(): void {
  located.value = null;
  scanShown.value = false;
  scene().overlay("scan", []);
}

/** Segment a scan, find its pose, and draw both. */
export async function locate(file: File): Promise<void> {
  busy.value = `Cutting ${file.name} into segments.`;
  clear();
  const scan = await attempt(() => api.scan(file));
  if (scan) {
    located.value = { file, scan, answers: null };
    draw(located.value, null);
    if (scan.segments.length && list.value?.maps.length) await search(located.value);
  }
  busy.value = "";
}

async function search(found: Located): Promise<void> {
  busy.value = "Searching the maps.";
  const answer = await attempt(() => api.localize({
    segments: found.scan.segments.map(({ points }, index) => ({ points, sensor: found.scan.sensors[index] ?? [0, 0, 0] })),
    ...(searched.value ? { maps: [searched.value] } : {}),
  }));
  busy.value = "";
  if (!answer) return;
  located.value = { ...found, answers: answer.localizations };
  const best = answer.localizations[0];
  if (best?.localized) await showIn(best);
}

async function showIn(answer: Localization): Promise<void> {
  if (!open.value.has(answer.map)) await openMap(answer.map, false);
  current.value = answer.map;
  const found = located.value!;
  draw(found, answer);
  const layer = scene().layers.get(answer.map);
  if (!layer || !answer.pose) return;
  const place = vector(answer.pose.translation).applyMatrix4(layer.pose);
  scene().look(place, 45);
  matched.value = new Map([[answer.map, new Map(answer.inliers.map((each) => [each.id, 1 - Math.min(each.residual, 1)]))]]);
  recolor();
}

/** Draw the cloud, colored by segment, and the lines from its segments to those of the map. */
function draw(found: Located, answer: Localization | null): void {
  const layer = answer ? scene().layers.get(answer.map) : undefined;
  const pose = answer?.pose && layer ? layer.pose.multiply(matrixOf(answer.pose)) : matrixOf({ translation: outside(), rotation: [0, 0, 0, 1] });
  const { points, labels } = found.scan.cloud;
  const places = points.map((point) => vector(point).applyMatrix4(pose));
  const colors = labels.map((label): Color => (label >= 0 ? kindColor(label) : GRAY));
  const lines: Line[] = [...arrow(pose, 2.5, FIX)];
  if (layer && answer) {
    for (const { query, id } of answer.inliers) {
      const row = layer.rowOf(id);
      const centroid = found.scan.segments[query]?.centroid;
      if (row === undefined || !centroid) continue;
      const from = vector(centroid).applyMatrix4(pose);
      const lift = from.clone().add(new Vector3(0, 0, 8));
      lines.push({ from, to: lift, color: FIX }, { from: lift, to: layer.position(row), color: FIX });
    }
    if (answer.covariance) lines.push(...ellipse(new Vector3().applyMatrix4(pose), answer.covariance, FIX));
  }
  scanShown.value = true;
  scene().overlay("scan", lines, [{ points: places, colors, size: 2 }]);
  if (!answer) scene().look(new Vector3().applyMatrix4(pose), 45);
}

/** A free place beside the open maps. */
function outside(): Vector {
  let left = 0;
  for (const layer of scene().layers.values()) left = Math.min(left, layer.low.clone().applyMatrix4(layer.pose).x - 60);
  return [left, 0, 0];
}

const REASONS: Record<string, string> = {
  "too-few-segments": "The scan shows too few segments.", ambiguous: "Two places fit nearly as well.", inconsistent: "No place fits well enough.",
};

/** What an operator can do if no map gave a pose. The service's own advice is for the programs of robots. */
function adviceFor(answers: Localization[], names: string[]): string {
  const [first] = answers;
  if (first?.rival) {
    return `The maps ${first.map} and ${first.rival.map} both have a place like this one. If they show the same area, search one of them, or merge them.`;
  }
  const drive = first?.meters_to_drive;
  const farther = drive ? ` Or take a scan about ${drive.toFixed(0)} m farther on, where there are more segments.` : " Or take another scan some meters farther on.";
  return `Check that ${names.length === 1 ? "the map covers" : "one of the maps covers"} this place, that z points up, and that lengths are meters.${farther}`;
}

export function Locate() {
  const found = located.value;
  const [name, setName] = useState("");
  const taken = (list.value?.maps ?? []).some((each) => each.name === name);
  return (
    <>
      <p>Drop one LiDAR scan on this page to see its segments and where it was taken. PCD, PLY, LAS, LAZ, KITTI .bin, NumPy and CSV files work; z must point up.</p>
      <div class="row">
        <label class="grow">
          Search in{" "}
          <select
            value={searched.value}
            onChange={(event) => {
              searched.value = event.currentTarget.value;
              if (found?.scan.segments.length) void search(found);
            }}
          >
            <option value="">all maps</option>
            {(list.value?.maps ?? []).map((each) => <option key={each.name} value={each.name}>{each.name}</option>)}
          </select>
        </label>
        <FileButton label="Choose a scan" onFile={(file) => void locate(file)} />
      </div>
      {busy.value && <p role="status">{busy.value}</p>}
      {found && (
        <section aria-label="Result" aria-live="polite">
          <h2>{found.file.name}</h2>
          <p>{found.scan.format}: {count(found.scan.points)} points, {count(found.scan.segments.length)} segments.</p>
          {found.scan.problems.map((each) => <p key={each.what} class="warning">{each.what} {each.cure}</p>)}
          {!found.scan.segments.length && <p>No segment was found. A segment is an object of 100 or more points, such as a car or a trunk. Check that z points up and that lengths are meters.</p>}
          {(found.answers?.length === 0 || list.value?.maps.length === 0) && <p>There is no map to search. {mayWriteAny.value && "Make a new map of the scan: the service then knows this place."}</p>}
          {found.answers && found.answers.length > 0 && !found.answers.some((each) => each.localized) && (
            <p class="warning"><b>The scan was not located.</b> {adviceFor(found.answers, (list.value?.maps ?? []).map((each) => each.name))}</p>
          )}
          {found.answers?.[0]?.rival && !found.answers[0].localized && (
            <div class="row">
              {[found.answers[0].map, found.answers[0].rival.map].map((each) => (
                <Button key={each} onClick={() => { searched.value = each; void search(found); }}>Search only {each}</Button>
              ))}
            </div>
          )}
          {(found.answers ?? []).slice(0, 5).map((answer) => <Answer key={answer.map} answer={answer} file={found.file} />)}
          {mayWriteAny.value && found.scan.segments.length > 0 && (
            <form class="row" onSubmit={(event) => { event.preventDefault(); if (!taken) void add(found.file, name, null); }}>
              <label class="grow">Make a new map of the scan <input placeholder="Name of the new map" required pattern="[A-Za-z0-9][A-Za-z0-9._\-]{0,63}" value={name} onInput={(event) => setName(event.currentTarget.value)} /></label>
              <button type="submit" aria-disabled={taken}>Make</button>
              {taken && <span role="alert">There is a map {name} already. A scan comes into a map at its pose there: search in {name}.</span>}
            </form>
          )}
          <Button onClick={clear}>Clear</Button>
        </section>
      )}
    </>
  );
}

async function add(file: File, name: string, pose: Pose | null): Promise<void> {
  const before = list.value?.maps.find((each) => each.name === name)?.segments ?? 0;
  const written = await attempt(() => api.addScan(name, "page", file, pose));
  if (!written) return;
  const known = written.repeats ? `; ${count(written.repeats)} were there already` : "";
  say("done", `${count(written.segments - before)} segments of ${file.name} added to ${name}${known}`, pose ? "To undo this, restore the version before under Versions." : "");
  await refresh();
  await openMap(name, pose === null);
}

function Answer(props: { answer: Localization; file: File }) {
  const { answer, file } = props;
  const { pose } = answer;
  return (
    <div class={answer.localized ? "answer good" : "answer"}>
      <b>{answer.localized ? `In ${answer.map}` : `Not localized in ${answer.map}`}</b>
      {pose && answer.localized ? (
        <>
          <p>x {meters(pose.translation[0])}, y {meters(pose.translation[1])}, z {meters(pose.translation[2])}, heading {degrees(pose.yaw)}</p>
          <p>{percent(answer.probability)} sure; {answer.inliers.length} segments agree.</p>
          <div class="row">
            <Button onClick={() => void showIn(answer)}>Show</Button>
            {mayWrite(answer.map) && <Button onClick={() => void add(file, answer.map, pose)}>Add to {answer.map}</Button>}
          </div>
        </>
      ) : (
        <p>{REASONS[answer.reason ?? ""] ?? ""} {answer.detail}</p>
      )}
    </div>
  );
}
