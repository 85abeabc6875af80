// Align another map with this one, look at the proposal, then merge both; a merge can be undone.
import { signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../api/client";
import type { Alignment, MapSummary, Merged, Pose } from "../api/types";
import { FIX, GRAY } from "../scene/colors";
import { matrixOf, type Line } from "../scene/scene";
import { attempt, closeMap, list, mayWrite, mayWriteAny, open, openMap, refresh, say, scene } from "../state/store";
import { Button, count, degrees, Dialog, meters, percent } from "./parts";

/** The last merge that was written, until it is undone. */
const lastMerge = signal<Merged | null>(null);

interface Proposal {
  label: string;
  pose: Pose;
  note: string;
}

export function Merge(props: { map: MapSummary }) {
  const { map } = props;
  const others = (list.value?.maps ?? []).filter((each) => each.name !== map.name);
  const [other, setOther] = useState(others[0]?.name ?? "");
  const [busy, setBusy] = useState("");
  const [found, setFound] = useState<Alignment | null>(null);
  const [chosen, setChosen] = useState(0);
  const [target, setTarget] = useState(map.name);
  const [plan, setPlan] = useState<Merged | null>(null);
  // A preview of another way ends with the panel: the maps lie as they fit best.
  const best = useRef<(() => void) | null>(null);
  useEffect(() => () => { best.current?.(); scene().overlay("pairs", []); }, []);

  const align = async (): Promise<void> => {
    setBusy("Aligning. This takes some seconds.");
    setFound(null);
    setPlan(null);
    const answer = await attempt(async () => {
      for (const name of [map.name, other]) if (!open.value.has(name)) await openMap(name, false);
      return api.align(map.name, other);
    });
    setBusy("");
    if (!answer) return;
    setFound(answer);
    best.current = answer.pose ? () => place(answer, answer.pose!) : null;
    show(answer, 0);
  };
  const show = (answer: Alignment, index: number): void => {
    setChosen(index);
    const proposal = proposalsOf(answer)[index];
    if (proposal) draw(answer, proposal.pose);
  };
  const merge = async (dryRun: boolean): Promise<void> => {
    setBusy(dryRun ? "Trying the merge. Nothing is written." : "Merging.");
    const existing = list.value?.maps.find((each) => each.name === target) ?? null;
    const parts = [map.name, other].filter((name) => name !== target);
    const answer = await attempt(() => api.merge(target, parts, dryRun, existing?.etag ?? null));
    setBusy("");
    if (!answer) return;
    if (dryRun) {
      setPlan(answer);
      return;
    }
    setPlan(null);
    lastMerge.value = answer;
    const added = answer.parts.reduce((sum, part) => sum + (part.merged ? part.added : 0), 0);
    say("done", `${parts.join(" and ")} merged into ${target}`, `${count(added)} segments added. Undo is in the list of maps.`);
    best.current = null;
    setFound(null);
    scene().overlay("pairs", []);
    // The merged map shows the segments of its parts; each of them would be drawn twice.
    for (const part of parts) if (open.value.has(part)) closeMap(part);
    await refresh();
    await openMap(target);
  };
  if (!others.length) return <p>There is no other map to align with.</p>;
  const proposals = found ? proposalsOf(found) : [];
  const exists = (list.value?.maps ?? []).some((each) => each.name === target);
  return (
    <>
      <div class="row">
        <label class="grow">
          Other map{" "}
          <select value={other} onChange={(event) => { setOther(event.currentTarget.value); setFound(null); setPlan(null); }}>
            {others.map((each) => <option key={each.name} value={each.name}>{each.name}</option>)}
          </select>
        </label>
        <Button kind="main" disabled={busy !== ""} onClick={() => void align()}>Align</Button>
      </div>
      {busy && <p role="status">{busy}</p>}
      {found && (
        <div role="status">
          <p>
            {found.aligned ? `${other} fits: ${found.pairs} pairs of segments agree.` : `${other} is not aligned. ${found.detail}`}
            {found.overlap && ` It covers ${percent(found.overlap.of_map)} of ${map.name}.`}
          </p>
          {proposals.map((proposal, index) => (
            <Button key={proposal.label} pressed={chosen === index} onClick={() => show(found, index)}>
              {proposal.label}: {proposal.note}
            </Button>
          ))}
          {found.aligned && chosen > 0 && <p class="warning">The picture shows the second way. A merge uses the best one.</p>}
        </div>
      )}
      {found?.aligned && mayWriteAny.value && (
        <>
          <div class="row">
            <label class="grow">
              Merge into map <input value={target} pattern="[A-Za-z0-9][A-Za-z0-9._\-]{0,63}" onInput={(event) => { setTarget(event.currentTarget.value); setPlan(null); }} />
            </label>
            <Button disabled={busy !== "" || !target || !mayWrite(target)} onClick={() => void merge(true)}>Try the merge</Button>
          </div>
          <p class="facts">{exists ? `The map ${target} gets a new version.` : `A new map ${target} is made.`} {map.name !== target && `${map.name} stays as it is. `}{other} stays as it is.</p>
        </>
      )}
      {plan && (
        <Dialog title={`Merge into ${plan.map}?`} onClose={() => setPlan(null)}>
          <ul>
            {plan.parts.map((part) => (
              <li key={part.map}>{part.merged ? `${part.map}: ${count(part.added)} segments added, ${count(part.repeats)} were there already` : `${part.map} is left out: it does not fit`}</li>
            ))}
          </ul>
          <p>The map will have {count(plan.segments)} segments. You can undo the merge.</p>
          <div class="row">
            <Button kind="main" disabled={plan.parts.every((part) => !part.merged)} onClick={() => void merge(false)}>Merge</Button>
            <Button onClick={() => setPlan(null)}>Cancel</Button>
          </div>
        </Dialog>
      )}
    </>
  );
}

/** Offers to undo the last merge, whichever map is shown. */
export function UndoMerge() {
  const merged = lastMerge.value;
  if (!merged) return null;
  const undo = async (): Promise<void> => {
    lastMerge.value = null;
    const gone = await attempt(async () => {
      if (merged.previous === null) await api.deleteMap(merged.map, merged.etag!);
      else await api.restore(merged.map, merged.previous, merged.etag!);
      return true;
    });
    if (!gone) return;
    say("done", `The merge into ${merged.map} is undone`, merged.previous === null ? `The map ${merged.map} is deleted.` : `${merged.map} is as it was in version ${merged.previous}.`);
    await refresh();
    for (const { map } of merged.parts) if (!open.value.has(map) && list.value?.maps.some((each) => each.name === map)) await openMap(map, false);
    scene().fit();
  };
  return (
    <div class="row answer good" role="status">
      <span class="grow">{merged.map} has {count(merged.segments)} segments after the merge.</span>
      <Button kind="danger" onClick={() => void undo()}>Undo the merge</Button>
    </div>
  );
}

/** The poses that fit: the best one, and in an ambiguous answer those that fit as well. */
function proposalsOf(found: Alignment): Proposal[] {
  const note = (pose: Pose, pairs: number): string =>
    `${pairs} pairs, ${meters(Math.hypot(...pose.translation))} away, turned by ${degrees(pose.yaw)}`;
  const best = found.pose ? [{ label: "Best", pose: found.pose, note: note(found.pose, found.pairs) }] : [];
  return [
    ...best,
    ...found.others.map((each, index) => ({ label: found.pose ? "Second" : `Way ${index + 1}`, pose: each.pose, note: note(each.pose, each.pairs) })),
  ];
}

/** Place the other map as a pose says. */
function place(found: Alignment, pose: Pose): void {
  const [a, b] = [scene().layers.get(found.map), scene().layers.get(found.other)];
  if (a && b) b.place(a.pose.multiply(matrixOf(pose)));
  scene().redraw();
}

function draw(found: Alignment, pose: Pose): void {
  const [a, b] = [scene().layers.get(found.map), scene().layers.get(found.other)];
  if (!a || !b) return;
  place(found, pose);
  const best = found.pose === pose;
  const lines: Line[] = found.inliers.flatMap((pair) => {
    const [row, otherRow] = [a.rowOf(pair.id), b.rowOf(pair.other_id)];
    if (row === undefined || otherRow === undefined) return [];
    const from = a.position(row);
    const lift = from.clone().setZ(from.z + 6);
    return [{ from, to: lift, color: best ? FIX : GRAY }, { from: lift, to: b.position(otherRow), color: best ? FIX : GRAY }];
  });
  scene().overlay("pairs", lines);
  scene().fit();
}
