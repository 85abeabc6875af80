// The versions of a map as a time line; a version can be looked at and restored.
import { useEffect, useState } from "preact/hooks";
import { api } from "../api/client";
import { parseDelta, readMap, rowOf, type MapContent } from "../api/map_file";
import type { MapSummary, Version, Written } from "../api/types";
import { ADDED, REMOVED } from "../scene/colors";
import { attempt, changesShown, connected, mayWrite, recolor, refresh, say, scene } from "../state/store";
import { Button, count, Dialog } from "./parts";
import { Vector3 } from "three";

const OPERATIONS: Record<string, string> = {
  put: "stored whole", edit: "edited", merge: "merged", restore: "restored an earlier version", age: "pruned", optimize: "moved by an optimization",
};

export function Versions(props: { map: MapSummary }) {
  const { map } = props;
  const [versions, setVersions] = useState<Version[] | null>(null);
  const [failed, setFailed] = useState(false);
  const [changes, setChanges] = useState<Changes | null>(null);
  const shown = changesShown.value?.map === map.name ? changesShown.value.version : null;
  const [asked, setAsked] = useState<{ version: Version; effect: Written | null } | null>(null);
  // Without a connection the list cannot be read; it is read when the service is back.
  const again = failed && connected.value.on;
  useEffect(() => {
    if (versions && !failed) return;
    void attempt(() => api.versions(map.name)).then((found) => {
      setFailed(!found);
      if (found) setVersions(found);
    });
  }, [again]);
  useEffect(() => () => hide(), []);
  if (!versions) return <p role="status">{failed ? "The versions could not be read. The page tries again when the service answers." : "Loading the versions."}</p>;
  const look = async (version: Version): Promise<void> => {
    hide();
    if (shown === version.sequence) return;
    const found = await readChanges(map.name, version.sequence);
    if (!found) return;
    setChanges(found);
    draw(map.name, found);
    changesShown.value = { map: map.name, version: version.sequence };
    recolor();
  };
  const ask = async (version: Version): Promise<void> => {
    const effect = await api.restore(map.name, version.sequence, map.etag, true).catch(() => null);
    setAsked({ version, effect });
  };
  const restore = async (): Promise<void> => {
    const { version } = asked!;
    setAsked(null);
    if (!(await attempt(() => api.restore(map.name, version.sequence, map.etag)))) return;
    say("done", `Version ${version.sequence} of ${map.name} is restored`, `To undo this, restore version ${map.sequence}.`);
    await refresh();
  };
  const undone = asked ? versions.filter((each) => each.sequence > asked.version.sequence) : [];
  return (
    <>
      <ol class="versions">
        {versions.map((version, index) => (
          <li key={version.sequence}>
            <b>Version {version.sequence}</b> {index === 0 && <em>now</em>}
            <span class="facts">
              {new Date(1000 * version.time).toISOString().slice(0, 16).replace("T", " ")}, {OPERATIONS[version.operation] ?? version.operation} by {version.author}:{" "}
              {sizeOf(version)}
            </span>
            {shown === version.sequence && changes && (
              <span class="facts" role="status">
                Shown in the picture: {count(changes.added.length)} segments added or replaced in version {version.sequence}, {count(changes.gone.length)} removed.
              </span>
            )}
            <div class="row">
              <Button pressed={shown === version.sequence} onClick={() => void look(version)}>Show changes</Button>
              {index > 0 && mayWrite(map.name) && <Button onClick={() => void ask(version)}>Restore</Button>}
            </div>
          </li>
        ))}
      </ol>
      {asked && (
        <Dialog title={`Restore version ${asked.version.sequence}?`} onClose={() => setAsked(null)}>
          <p>The map {map.name} will be as it was in version {asked.version.sequence}. This undoes {undone.length === 1 ? "one version" : `${undone.length} versions`}:</p>
          <ul>
            {undone.slice(0, 6).map((each) => (
              <li key={each.sequence}>version {each.sequence}, {OPERATIONS[each.operation] ?? each.operation} by {each.author}: {sizeOf(each)}</li>
            ))}
          </ul>
          {asked.effect && <p>{count(asked.effect.changed)} segments will be added or replaced, {count(asked.effect.removed)} removed.</p>}
          <p>Nothing is lost: the restore is a new version, and can be undone too.</p>
          <div class="row">
            <Button kind="main" onClick={() => void restore()}>Restore</Button>
            <Button onClick={() => setAsked(null)}>Cancel</Button>
          </div>
        </Dialog>
      )}
    </>
  );
}

/** Size of a version. A restore is stored whole, so its numbers do not say what it changed. */
function sizeOf(version: Version): string {
  if (version.operation === "restore") return `all ${count(version.changed)} segments stored again`;
  return `${count(version.changed)} added or replaced, ${count(version.removed)} removed`;
}

/** Positions of the segments that a version changed, in the map's frame. */
interface Changes {
  added: Vector3[];
  gone: Vector3[];
}

async function readChanges(name: string, sequence: number): Promise<Changes | undefined> {
  return attempt(async () => {
    const { changed, removed, whole } = parseDelta(name, await api.versionChanges(name, sequence));
    const at = (map: MapContent, row: number): Vector3 => new Vector3().fromArray(map.centroids, 3 * row);
    const rows = Array.from(changed.ids, (_, row) => row);
    // The removed segments are in the version before only.
    const before = sequence > 1 && (whole || removed.length)
      ? await readMap(name, sequence - 1).catch((error: unknown) => { if (whole) return null; throw error; }) : null;
    if (!before) return { added: rows.map((row) => at(changed, row)), gone: [] };
    if (!whole) {
      const gone = [...removed].flatMap((id) => { const row = rowOf(before.ids, id); return row === undefined ? [] : [at(before, row)]; });
      return { added: rows.map((row) => at(changed, row)), gone };
    }
    // A version that is stored whole is compared with the one before, by ids, positions and robots.
    const same = (row: number): boolean => {
      const old = rowOf(before.ids, changed.ids[row]!);
      return old !== undefined && before.robots[before.robot[old]!] === changed.robots[changed.robot[row]!]
        && at(before, old).distanceTo(at(changed, row)) < 0.005;
    };
    const gone = Array.from(before.ids, (id, row) => (rowOf(changed.ids, id) === undefined ? [at(before, row)] : [])).flat();
    return { added: rows.filter((row) => !same(row)).map((row) => at(changed, row)), gone };
  });
}

function draw(name: string, { added, gone }: Changes): void {
  const layer = scene().layers.get(name);
  if (!layer) return;
  const placed = (points: Vector3[]): Vector3[] => points.map((point) => point.clone().applyMatrix4(layer.pose));
  scene().overlay("version", [], [
    { points: placed(added), colors: added.map(() => ADDED), size: 5 }, { points: placed(gone), colors: gone.map(() => REMOVED), size: 5 },
  ]);
}

function hide(): void {
  scene().overlay("version", []);
  if (!changesShown.value) return;
  changesShown.value = null;
  recolor();
}
