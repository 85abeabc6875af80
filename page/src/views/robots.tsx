// Robots that reported lately: where each is, how sure, or why it is not localized.
import { useEffect } from "preact/hooks";
import { Vector3 } from "three";
import type { ServiceEvent } from "../api/events";
import type { RobotState } from "../api/types";
import { css, FIX, GRAY } from "../scene/colors";
import { arrow, ellipse, matrixOf, vector, type Line } from "../scene/scene";
import { connected, current, events, fixes, open, openMap, robotColor, robots, scene, tab, trails } from "../state/store";
import { ago, Button, isLost, meters, percent } from "./parts";
import { Swatch } from "./stage";

/** Draw all robots in the open maps; runs whenever one moves. */
export function drawRobots(): void {
  const view = scene();
  if (!view) return;
  const lines: Line[] = [];
  for (const robot of robots.value) {
    const layer = robot.map ? view.layers.get(robot.map) : undefined;
    if (!layer || !robot.position) continue;
    const color = robot.age > 60 ? GRAY : robotColor(robot.robot);
    const frame = layer.pose;
    const pose = frame.clone().multiply(matrixOf({ translation: robot.position, rotation: robot.orientation ?? [0, 0, 0, 1] }));
    lines.push(...arrow(pose, Math.max(2, view.reach() / 25), color));
    if (robot.covariance) lines.push(...ellipse(new Vector3().applyMatrix4(pose), robot.covariance, color));
    const trail = trails.value.get(robot.robot);
    if (trail?.map === robot.map) {
      const places = trail.places.map((place) => vector(place).applyMatrix4(frame));
      places.slice(1).forEach((to, index) => lines.push({ from: places[index]!, to, color }));
    }
  }
  for (const fix of fixes.value.values()) {
    const layer = view.layers.get(fix.map);
    if (!layer) continue;
    const from = vector(fix.position).applyMatrix4(layer.pose);
    for (const id of fix.inliers) {
      const row = layer.rowOf(id);
      if (row !== undefined) lines.push({ from, to: layer.position(row), color: FIX });
    }
  }
  view.overlay("robots", lines);
}

export function Robots() {
  return (
    <>
      {!robots.value.length && <p>No robot has reported in the last minutes. Robots report while they run <code>placecell robot</code>.</p>}
      <ul class="robots">{robots.value.map((robot) => <Entry key={robot.robot} robot={robot} />)}</ul>
      <h2>Events</h2>
      {!connected.value.on && <p class="warning">Not connected. {connected.value.reason}</p>}
      <ol class="events">
        {events.value.slice(0, 40).map((event) => (
          <li key={event.id}><time>{clockOf(event)}</time> <span>{describe(event)}</span></li>
        ))}
      </ol>
      {!events.value.length && <p class="facts">Nothing has happened since this page was opened. Positions of robots are above; here are fixes, uploads, merges, alarms, and changes of a robot's state.</p>}
    </>
  );
}

function clockOf(event: ServiceEvent): string {
  const seconds = Number(event.data["received"] ?? event.data["time"]);
  return Number.isFinite(seconds) ? new Date(1000 * seconds).toTimeString().slice(0, 8) : "";
}

const OPERATIONS: Record<string, string> = {
  put: "was stored whole", edit: "was edited", merge: "was merged", restore: "was restored to an earlier version", age: "was pruned", delete: "was deleted",
};

/** An event as a sentence. */
function describe({ kind, data }: ServiceEvent): string {
  const text = (name: string): string => (typeof data[name] === "string" || typeof data[name] === "number" ? String(data[name]) : "");
  const who = text("robot") || (text("session") ? `session ${text("session")}` : "a robot");
  const map = text("map");
  if (kind === "fix") return `${who} was localized in ${map}.`;
  if (kind === "no-fix") return `${who} was not localized: ${text("reason").replaceAll("-", " ")}.`;
  if (kind === "robot") return `${who} is ${text("state")}${map && data["position"] && data["pose_age"] === data["age"] ? ` in ${map}` : ""}. ${text("reason")}`;
  if (["upload", "merge", "write"].includes(kind)) {
    const now = text("segments") ? ` It has ${Number(text("segments")).toLocaleString("en-US")} segments.` : "";
    return `Map ${map} ${OPERATIONS[text("operation")] ?? `was changed (${text("operation")})`}.${now}`;
  }
  if (kind === "alarm") return `Alarm ${text("alarm")} ${data["raised"] === false ? "has ended" : "began"}. ${text("detail")}`;
  if (kind === "missed" || kind === "dropped") return "Some events were lost: the service was restarted, or the link was too slow.";
  if (kind === "stopping") return "The service stops.";
  return kind;
}

/** What an operator can do for a robot without a pose. */
const LOST = "What to do: let the robot drive on, so that it sees more segments. If it stays lost, drop a scan from there on this page: "
  + "the page shows which maps know the place.";


function Entry(props: { robot: RobotState }) {
  const { robot } = props;
  const spread = robot.covariance ? Math.sqrt(Math.max(robot.covariance[0]?.[0] ?? 0, robot.covariance[1]?.[1] ?? 0)) : null;
  // Both ages are of one moment: a pose of the last report is as old as the report.
  const old = isLost(robot);
  const silent = robot.age > 60;
  const show = async (): Promise<void> => {
    if (!robot.map || !robot.position) return;
    if (!open.value.has(robot.map)) await openMap(robot.map, false);
    current.value = robot.map;
    const layer = scene().layers.get(robot.map);
    if (layer) scene().look(vector(robot.position).applyMatrix4(layer.pose), 40);
    drawRobots();
  };
  return (
    <li>
      <Swatch color={css(robot.age > 60 ? GRAY : robotColor(robot.robot))} />
      <div>
        <b>{robot.robot}</b> <em class={old || silent ? "badge bad" : "badge"}>{silent ? `silent, was ${robot.state}` : robot.state}</em>
        <span class="facts">
          {robot.map && robot.position ? `${old ? "last seen in" : "in"} ${robot.map} at x ${robot.position[0].toFixed(1)}, y ${robot.position[1].toFixed(1)}` : "no pose yet"}
          {spread !== null && !old && `, within ${meters(2 * spread)}`}
          {robot.probability !== null && !old && `, ${percent(robot.probability)} sure`}, {ago(robot.pose_age ?? robot.age)}
        </span>
        {robot.reason && <span class="facts warning">{robot.reason}</span>}
      </div>
      {robot.map && robot.position && <Button onClick={() => void show()} label={`Show ${old ? "the last pose of " : ""}${robot.robot}`}>{old ? "Last pose" : "Show"}</Button>}
      {(old || silent) && (
        <p class="facts">{silent ? `It has not reported for ${ago(robot.age).replace(" ago", "")}. Check that it runs and that its link works.` : LOST}</p>
      )}
    </li>
  );
}

/** Keeps the robots in the scene up to date, whichever panel is open. */
export function RobotDrawer() {
  const state = [robots.value, trails.value, fixes.value, open.value, tab.value];
  useEffect(drawRobots, state);
  return null;
}
