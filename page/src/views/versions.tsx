// The versions of a map as a time line; a version can be looked at and restored.
import { useEffect, useState } from "preact/hooks";
import { api } from "../api/client";
import { parseDelta, readMap, rowOf, type MapContent } from "../api/map_file";
import type { MapSummary, Version, Written } from "../api/types";
import { ADDED, css, REMOVED } from "../scene/colors";
import { attempt, mayWrite, refresh, say, scene } from "../state/store";
import { Button, count, Dialog } from "./parts";
import { Swatch } from "./stage";
import { Vector3 } from "three";

const OPERATIONS: Record<string, string> = {
  put: "stored whole", edit: "edited", merge: "merged", restore: "restored an earlier version", age: "pruned",
};

export function Versions(props: { map: MapSummary }) {
  const { map } = props;
  const [versions, setVersions] = useState<Version[] | null>(null);
  const [shown, setShown] = useState<number | null>(null);
  const [asked, setAsked] = useState<{ version: Version; effect: Written | null } | null>(null);
  useEffect(() => {
    void attempt(() => api.versions(map.name)).then((found) => setVersions(found ?? []));
    return () => scene().overlay("version", []);
  }, [map.etag]);
  if (!versions) return <p>Loading the versions.</p>;
  const look = async (version: Version): Promise<void> => {
    if (shown === version.sequence) {
      setShown(null);
      scene().overlay("version", []);
    } else if (await showChanges(map.name, version.sequence)) setShown(version.sequence);
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
              {count(version.changed)} added or replaced, {count(version.removed)} removed
            </span>
            <div class="row">
              <Button pressed={shown === version.sequence} onClick={() => void look(version)}>Show changes</Button>
              {index > 0 && mayWrite(map.name) && <Button onClick={() => void ask(version)}>Restore</Button>}
            </div>
          </li>
        ))}
      </ol>
      {shown !== null && (
        <p role="status"><Swatch color={css(ADDED)} /> added or replaced in version {shown} <Swatch color={css(REMOVED)} /> removed</p>
      )}
      {asked && (
        <Dialog title={`Restore version ${asked.version.sequence}?`} onClose={() => setAsked(null)}>
          <p>The map {map.name} will be as it was in version {asked.version.sequence}. This undoes {undone.length === 1 ? "one version" : `${undone.length} versions`}:</p>
          <ul>
            {undone.slice(0, 6).map((each) => (
              <li key={each.sequence}>version {each.sequence}, {OPERATIONS[each.operation] ?? each.operation} by {each.author}: {count(each.changed)} added or replaced, {count(each.removed)} removed</li>
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

async function showChanges(name: string, sequence: number): Promise<boolean> {
  const layer = scene().layers.get(name);
  const found = await attempt(async () => {
    const delta = parseDelta(name, await api.versionChanges(name, sequence));
    // The removed segments stand in the version before only.
    return { ...delta, before: delta.removed.length ? await readMap(name, sequence - 1) : null };
  });
  if (!found || !layer) return false;
  const { changed, removed, before } = found;
  const at = (map: MapContent, row: number): Vector3 => new Vector3().fromArray(map.centroids, 3 * row).applyMatrix4(layer.pose);
  const added = Array.from(changed.ids, (_, row) => at(changed, row));
  const gone = [...removed].flatMap((id) => {
    const row = before ? rowOf(before.ids, id) : undefined;
    return before && row !== undefined ? [at(before, row)] : [];
  });
  scene().overlay("version", [], [
    { points: added, colors: added.map(() => ADDED), size: 6 }, { points: gone, colors: gone.map(() => REMOVED), size: 6 },
  ]);
  return true;
}
