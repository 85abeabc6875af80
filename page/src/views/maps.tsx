// The list of maps, and what can be done with the current one.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import { api, ApiError } from "../api/client";
import { isMapFile } from "../api/map_file";
import type { MapDetail, MapSummary } from "../api/types";
import { moment } from "../scene/coloring";
import {
  attempt, closeMap, current, currentSummary, details, list, loading, mayWrite, mayWriteAny, open, openMap, refresh, say, scene, tab,
} from "../state/store";
import { locate } from "./locate";
import { Merge, UndoMerge } from "./merge";
import { Optimize, UndoOptimization } from "./optimize";
import { ago, Button, bytes, count, Dialog, FileButton } from "./parts";
import { Versions } from "./versions";

export const upload = signal<File | null>(null);

/** Take a file that was dropped or chosen: a map is stored, a scan is located. */
export async function takeFile(file: File): Promise<void> {
  if (await isMapFile(file)) {
    if (mayWriteAny.value) upload.value = file;
    else say("error", "This key may not store maps", "Sign in with a key that may write maps, then drop the file again.");
    return;
  }
  tab.value = "locate";
  await locate(file);
}

export function Maps() {
  const [wanted, setWanted] = useState("");
  const maps = list.value?.maps ?? [];
  const shown = maps.filter((each) =>
    `${each.name} ${Object.keys(each.robots).join(" ")} ${each.tags.join(" ")}`.toLowerCase().includes(wanted.toLowerCase()));
  const listed = shown.slice(0, 200);
  // The facts of the current map stand below its entry; below the list if the search hides it.
  const hidden = currentSummary.value && isCurrent(currentSummary.value) && !listed.includes(currentSummary.value) ? currentSummary.value : null;
  return (
    <>
      <div class="row">
        <label class="grow">
          <span class="hidden">Search maps and robots</span>
          <input type="search" placeholder="Search maps and robots" value={wanted} onInput={(event) => setWanted(event.currentTarget.value)} />
        </label>
        {mayWriteAny.value && <FileButton label="Add a file" onFile={(file) => void takeFile(file)} />}
      </div>
      {!list.value && <p role="status">Loading the list of maps.</p>}
      {list.value && maps.length > 0 && !shown.length && <p>No map and no robot has {wanted} in its name.</p>}
      {list.value && !maps.length && <p>There are no maps yet. A robot makes one with <code>placecell robot</code>; {mayWriteAny.value ? "or add a map file or a scan here." : "or sign in with a key that may write, and add a map file."}</p>}
      <UndoMerge />
      <UndoOptimization />
      <ul class="maps">
        {listed.map((each) => <Entry key={each.name} map={each} />)}
        {(list.value?.damaged ?? []).map((name) => (
          <li key={name} class="damaged"><b>{name}</b><span>damaged: it cannot be read. Restore it from a backup.</span></li>
        ))}
      </ul>
      {shown.length > 200 && <p>{count(shown.length - 200)} more maps. Search for a name.</p>}
      {hidden && <Current map={hidden} />}
    </>
  );
}

const isCurrent = (map: MapSummary): boolean => current.value === map.name && open.value.has(map.name);

function Entry(props: { map: MapSummary }) {
  const { map } = props;
  const isOpen = open.value.has(map.name);
  const robots = Object.keys(map.robots);
  const last = map.time_span?.[1];
  return (
    <li class={current.value === map.name ? "current" : ""}>
      <label class="check">
        <input
          type="checkbox" checked={isOpen || loading.value.has(map.name)} aria-label={`Show map ${map.name}`}
          onChange={() => (isOpen ? closeMap(map.name) : void openMap(map.name))}
        />
      </label>
      <button type="button" class="plain name" onClick={() => { if (isOpen) { current.value = map.name; scene().fit(map.name); } else void openMap(map.name); }}>{map.name}</button>
      <span class="facts">
        {count(map.segments)} segments, {bytes(map.bytes)}
        {robots.length === 1 ? `, ${robots[0]}` : `, ${robots.length} robots`}
        {last !== undefined && last > 1e8 ? `, seen ${ago(Date.now() / 1000 - last)}` : ""}
        {loading.value.has(map.name) ? ", loading" : ""}
      </span>
      {isCurrent(map) && <Current map={map} inEntry />}
    </li>
  );
}

const FORMATS = { ply: "PLY", las: "LAS", pcd: "PCD", mcap: "MCAP (Foxglove)", geojson: "GeoJSON", tum: "TUM path", g2o: "g2o" };

function Current(props: { map: MapSummary; inEntry?: boolean }) {
  const { map } = props;
  const [section, setSection] = useState<"facts" | "versions" | "merge" | "drift" | "prune">("facts");
  const [format, setFormat] = useState("map");
  const download = async (): Promise<void> => {
    const blob = await attempt(async () => (format === "map" ? (await api.mapFile(map.name, {})).blob() : api.exportMap(map.name, format)));
    if (!blob) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${map.name}.${format}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  };
  const facts: [string, string][] = [
    ["Frame", map.frame], ["Model", map.model_id], ["Version", String(map.sequence)],
    ["Robots", Object.entries(map.robots).slice(0, 20).map(([name, segments]) => `${name} (${count(segments)})`).join(", ")],
  ];
  if (map.time_span) facts.push(["Seen", `${moment(map.time_span[0])} to ${moment(map.time_span[1])}`]);
  if (Object.keys(map.sources).length) facts.push(["Merged from", Object.keys(map.sources).join(", ")]);
  if (map.tags.length) facts.push(["Tags", map.tags.join(", ")]);
  const detail = details.value.get(map.name);
  if (detail) facts.push(["Calibration", calibrationOf(detail)]);
  if (detail?.anchor) {
    const { lat, lon, height } = detail.anchor;
    facts.push(["On Earth", `${lat.toFixed(6)}, ${lon.toFixed(6)}, ${height.toFixed(1)} m${detail.anchor.applies ? "" : " (of an earlier frame)"}`]);
  }
  const write = mayWrite(map.name);
  const sections: [typeof section, string][] = [["facts", "Facts"], ["versions", "Versions"]];
  sections.push(["merge", write ? "Align and merge" : "Align"]);
  if (write) sections.push(["drift", "Remove drift"], ["prune", "Prune"]);
  return (
    <section class="current-map" aria-label={`Map ${map.name}`}>
      <h2 class={props.inEntry ? "hidden" : ""}>{map.name}</h2>
      <div class="row" role="group" aria-label="Part">
        {sections.map(([name, label]) => <Button key={name} pressed={section === name} onClick={() => setSection(name)}>{label}</Button>)}
      </div>
      {section === "facts" && (
        <>
          <dl>{facts.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}</dl>
          <div class="row">
            <label>
              <span class="hidden">File format</span>
              <select value={format} onChange={(event) => setFormat(event.currentTarget.value)}>
                <option value="map">map file</option>
                {Object.entries(FORMATS).map(([value, name]) => <option key={value} value={value}>{name}</option>)}
              </select>
            </label>
            <Button onClick={() => void download()}>Download</Button>
          </div>
        </>
      )}
      {section === "versions" && <Versions key={map.etag} map={map} />}
      {section === "merge" && <Merge key={map.name} map={map} />}
      {section === "drift" && <Optimize key={map.name} map={map} />}
      {section === "prune" && <Prune map={map} />}
    </section>
  );
}

function calibrationOf(detail: MapDetail): string {
  if (!detail.calibration) return "none: the model of the map is not loaded";
  const { state, read } = detail.calibration;
  return state === "default" ? "by the model" : `${state}, from ${count(read)} segments`;
}

function Prune(props: { map: MapSummary }) {
  const { map } = props;
  const span = map.time_span;
  const clock = span !== null && span[1] > 1e8;
  const [amount, setAmount] = useState(clock ? "30" : String(span ? Math.floor(span[0]) : 0));
  const [preview, setPreview] = useState<number | null>(null);
  const since = clock ? Date.now() / 1000 - 86_400 * Number(amount) : Number(amount);
  const look = async (): Promise<void> => {
    const answer = await attempt(() => api.prune(map.name, since, true));
    if (answer) setPreview(answer.removed);
  };
  const prune = async (): Promise<void> => {
    const answer = await attempt(() => api.prune(map.name, since, false));
    if (!answer) return;
    setPreview(null);
    say("done", `${count(answer.removed)} segments removed from ${map.name}`, "To undo this, restore the version before under Versions.");
    await refresh();
  };
  return (
    <>
      <p>Remove segments that no robot has seen again.{span && ` The segments of this map were last seen from ${moment(span[0])} to ${moment(span[1])}.`}</p>
      <div class="row">
        <label>
          {clock ? "Not seen for days " : "Not seen since second "}
          <input class="short" type="number" min="0" value={amount} onInput={(event) => { setAmount(event.currentTarget.value); setPreview(null); }} />
        </label>
        <Button onClick={() => void look()}>Preview</Button>
      </div>
      {preview !== null && (
        <div class="row" role="status">
          <span class="grow">{count(preview)} of {count(map.segments)} segments would be removed.</span>
          {preview > 0 && <Button kind="danger" onClick={() => void prune()}>Remove them</Button>}
        </div>
      )}
    </>
  );
}

export function UploadDialog() {
  const file = upload.value!;
  const [name, setName] = useState(file.name.replace(/\.[^.]*$/, "").replace(/[^A-Za-z0-9._-]/g, "-").replace(/^[^A-Za-z0-9]+/, "").slice(0, 64) || "map");
  const [problem, setProblem] = useState("");
  const store = async (event: Event): Promise<void> => {
    event.preventDefault();
    try {
      await api.uploadMap(name, file);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      setProblem(error.status === 412 ? `There is a map ${name} already. Choose another name.` : error.message);
      return;
    }
    upload.value = null;
    say("done", `Map ${name} is stored`);
    await refresh();
    await openMap(name);
  };
  return (
    <Dialog title="Store this map" onClose={() => (upload.value = null)}>
      <form onSubmit={(event) => void store(event)}>
        <p>{file.name}, {bytes(file.size)}</p>
        <label>Name <input required pattern="[A-Za-z0-9][A-Za-z0-9._\-]{0,63}" value={name} onInput={(event) => setName(event.currentTarget.value)} /></label>
        {problem && <p role="alert">{problem}</p>}
        <div class="row">
          <button type="submit" class="main">Store</button>
          <Button onClick={() => (upload.value = null)}>Cancel</Button>
        </div>
      </form>
    </Dialog>
  );
}
