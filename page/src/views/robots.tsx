// Robots that reported lately: where each is, how sure, or why it is not localized.
import { useEffect } from "preact/hooks";
import { Vector3 } from "three";
import type { RobotState } from "../api/types";
import { css, FIX, GRAY, kindColor } from "../scene/colors";
import { arrow, ellipse, matrixOf, vector, type Line } from "../scene/scene";
import { connected, current, events, fixes, open, openMap, robots, scene, tab, trails } from "../state/store";
import { ago, Button, meters, percent } from "./parts";
import { Swatch } from "./stage";

const colorOf = (name: string) => kindColor([...robots.value].map((each) => each.robot).sort().indexOf(name));

/** Draw all robots in the open maps; runs whenever one moves. */
export function drawRobots(): void {
  const view = scene();
  if (!view) return;
  const lines: Line[] = [];
  for (const robot of robots.value) {
    const layer = robot.map ? view.layers.get(robot.map) : undefined;
    if (!layer || !robot.position) continue;
    const color = robot.age > 60 ? GRAY : colorOf(robot.robot);
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
          <li key={event.id}><b>{event.kind}</b> <span>{describe(event.data)}</span></li>
        ))}
      </ol>
    </>
  );
}

function describe(data: Record<string, unknown>): string {
  return Object.entries(data)
    .filter(([, value]) => typeof value === "string" || typeof value === "number" || typeof value === "boolean")
    .map(([name, value]) => `${name.replaceAll("_", " ")} ${typeof value === "number" ? Number(value.toPrecision(6)) : String(value)}`)
    .join(", ");
}

function Entry(props: { robot: RobotState }) {
  const { robot } = props;
  const spread = robot.covariance ? Math.sqrt(Math.max(robot.covariance[0]?.[0] ?? 0, robot.covariance[1]?.[1] ?? 0)) : null;
  // Both ages are of one moment: a pose of the last report is as old as the report.
  const old = robot.pose_age === null || robot.pose_age > robot.age;
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
      <Swatch color={css(robot.age > 60 ? GRAY : colorOf(robot.robot))} />
      <div>
        <b>{robot.robot}</b> <em>{robot.state}</em>
        <span class="facts">
          {robot.map && robot.position ? `${old ? "last seen in" : "in"} ${robot.map} at x ${robot.position[0].toFixed(1)}, y ${robot.position[1].toFixed(1)}` : "no pose yet"}
          {spread !== null && !old && `, within ${meters(2 * spread)}`}
          {robot.probability !== null && !old && `, ${percent(robot.probability)} sure`}, {ago(robot.pose_age ?? robot.age)}
        </span>
        {robot.reason && <span class="facts warning">{robot.reason}</span>}
      </div>
      {robot.map && robot.position && <Button onClick={() => void show()}>Show</Button>}
    </li>
  );
}

/** Keeps the robots in the scene up to date, whichever panel is open. */
export function RobotDrawer() {
  const state = [robots.value, trails.value, fixes.value, open.value, tab.value];
  useEffect(drawRobots, state);
  return null;
}
