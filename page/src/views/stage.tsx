// The picture with what lies on it: tools, legend, compass, scale, position, selected segment.
import { useEffect, useRef, useState } from "preact/hooks";
import { COLOR_NAMES, type ColorBy } from "../scene/coloring";
import { vector, View } from "../scene/scene";
import {
  above, anchor, changesShown, colorBy, current, hiddenKinds, legend, loading, mayWriteAny, measured, measuring, open, picture, recolor,
  robots, scanShown, scene, select, selectId, showPaths, start,
} from "../state/store";
import { hasShapes, shapesOn, shapesShown, toggleShapes, watchShapes } from "../state/shapes";
import { isLost } from "./parts";
import { Vector3 } from "three";
import { Button, count, meters } from "./parts";
import { toWgs84 } from "./geo";

export function Stage() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [failure, setFailure] = useState("");
  const [pointer, setPointer] = useState<[number, number] | null>(null);
  useEffect(() => {
    try {
      void start(new View(canvas.current!));
      watchShapes();
    } catch (error) {
      setFailure(`This browser draws no 3D pictures (WebGL): ${error instanceof Error ? error.message : ""}`);
    }
  }, []);
  const down = useRef<[number, number]>([0, 0]);
  const at = (event: PointerEvent): [number, number] => {
    const box = canvas.current!.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const click = (event: PointerEvent): void => {
    const [x, y] = at(event);
    if (event.button !== 0 || Math.hypot(x - down.current[0], y - down.current[1]) > 4) return;
    const picked = scene().pick(x, y);
    select(picked ? { map: picked.layer.content.name, row: picked.row } : null);
  };
  const shown = open.value.size > 0 || scanShown.value;
  const waiting = [...loading.value];
  return (
    <section class="stage" aria-label="Map view">
      <canvas
        ref={canvas} tabIndex={0} role="img" aria-label="Segments of the open maps. Arrow keys move, plus and minus zoom, Q and E turn, T shows from above, F shows all."
        onPointerDown={(event) => (down.current = at(event))} onPointerUp={click}
        onPointerMove={(event) => setPointer(at(event))} onPointerLeave={() => setPointer(null)} onKeyDown={keys}
      />
      {failure && <p class="failure" role="alert">{failure}</p>}
      <Legend />
      <Labels />
      <Tools />
      {shown && <Compass />}
      {shown && <Scale pointer={pointer} />}
      {!shown && <p class="empty" role="status">{waiting.length ? `Loading ${waiting.join(", ")}.` : EMPTY[mayWriteAny.value ? 1 : 0]}</p>}
    </section>
  );
}

const EMPTY = [
  "Choose a map in the list to see it here, or drop a scan on this page to find where it was taken.",
  "Choose a map in the list to see it here. Drop a scan on this page to find where it was taken, or a map file to store it.",
];

/** Largest number of names in the picture. */
const MOST_LABELS = 60;

/** Names of the robots in the picture, and of the maps if there are several. */
function Labels() {
  const element = useRef<HTMLDivElement>(null);
  const view = scene();
  const [known, isSeveral] = [robots.value, open.value.size > 1];
  const places: { name: string; kind: string; place: Vector3 }[] = [];
  if (view) {
    for (const robot of known) {
      const layer = robot.map ? view.layers.get(robot.map) : undefined;
      if (!layer || !robot.position) continue;
      const name = isLost(robot) ? `${robot.robot}, last pose` : robot.robot;
      places.push({ name, kind: "robot", place: vector(robot.position).applyMatrix4(layer.pose) });
    }
    if (isSeveral) {
      for (const layer of view.layers.values()) {
        const { low, high, content } = layer;
        places.push({ name: content.name, kind: "map", place: new Vector3(0.5 * (low.x + high.x), high.y, low.z).applyMatrix4(layer.pose) });
      }
    }
  }
  places.splice(MOST_LABELS);
  // Only a picture with names costs time each time that it is drawn.
  if (places.length) void picture.value;
  useEffect(() => {
    if (!places.length) return;
    // The policy of the page forbids style attributes; positions are set by the script.
    const items = element.current!.children;
    const taken: [number, number][] = [];
    places.forEach(({ place }, index) => {
      const at = view.project(place);
      const item = items[index] as HTMLElement | undefined;
      if (!item) return;
      item.hidden = at === null;
      // A label moves down until it lies on no other; half a label is 60 pixels at most names.
      while (at && taken.some(([x, y]) => Math.abs(at[0] - x) < 90 && Math.abs(at[1] - y) < 17)) at[1] += 17;
      if (at) taken.push(at);
      if (at) item.style.transform = `translate(${at[0].toFixed(0)}px, ${at[1].toFixed(0)}px)`;
    });
  });
  if (!places.length) return null;
  return <div class="labels" aria-hidden="true" ref={element}>{places.map(({ name, kind }) => <span key={`${kind} ${name}`} class={kind}><b>{name}</b></span>)}</div>;
}

function keys(event: KeyboardEvent): void {
  const view = scene();
  const actions: Record<string, () => void> = {
    ArrowUp: () => view.pan(0, 1), ArrowDown: () => view.pan(0, -1), ArrowLeft: () => view.pan(-1, 0), ArrowRight: () => view.pan(1, 0),
    "+": () => view.zoom(1.25), "=": () => view.zoom(1.25), "-": () => view.zoom(0.8), q: () => view.turn(0.2), e: () => view.turn(-0.2),
    t: toggleAbove, f: () => view.fit(), m: toggleMeasure, Escape: () => select(null),
  };
  const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  action();
}

function toggleAbove(): void {
  above.value = !above.value;
  scene().setAbove(above.value);
}

function toggleMeasure(): void {
  measuring.value = !measuring.value;
  if (!measuring.value) {
    measured.value = null;
    scene().overlay("measure", []);
  }
}

function Tools() {
  const [id, setId] = useState("");
  const [told, setTold] = useState("");
  const [wide, setWide] = useState(false);
  const find = (event: Event): void => {
    event.preventDefault();
    if (!id) return;
    const [first, ...others] = selectId(Number(id));
    if (!open.value.size) setTold("Open a map first; its segments can then be found by id.");
    else if (!first) setTold(`${[...open.value.keys()].join(" and ")} ${open.value.size > 1 ? "have" : "has"} no segment ${id}.`);
    else setTold(others.length ? `Segment ${id} of ${first}. ${others.join(", ")} ${others.length > 1 ? "have" : "has"} this id too: press Find again.` : "");
  };
  return (
    <div class={wide ? "tools wide" : "tools"}>
      <button type="button" class="more" aria-expanded={wide} onClick={() => setWide(!wide)}>Tools</button>
      <label>
        Color by{" "}
        <select
          value={colorBy.value}
          onChange={(event) => {
            colorBy.value = event.currentTarget.value as ColorBy;
            hiddenKinds.value = new Set();
            recolor();
          }}
        >
          {Object.entries(COLOR_NAMES).map(([value, name]) => <option key={value} value={value}>{name}</option>)}
        </select>
      </label>
      <Button onClick={toggleAbove} pressed={above.value} title="Key: T">From above</Button>
      <Button onClick={() => scene().fit()} title="Key: F">Show all</Button>
      <Button onClick={toggleMeasure} pressed={measuring.value} title="Click two segments. Key: M">Measure</Button>
      <Button onClick={() => { showPaths.value = !showPaths.value; recolor(); }} pressed={showPaths.value}>Paths</Button>
      {hasShapes.value && <Button onClick={toggleShapes} pressed={shapesOn.value} title="Shapes that the service decodes from the codes of the segments">Shapes</Button>}
      <form onSubmit={find}>
        <label>
          <span class="hidden">Segment id</span>
          <input inputMode="numeric" pattern="[0-9]*" placeholder="Segment id" title="Id of a segment: digits only. Click a segment to see its id." value={id} onInput={(event) => { setId(event.currentTarget.value); setTold(""); }} />
        </label>
        <button type="submit">Find</button>
      </form>
      {told && <span role="alert">{told}</span>}
      <Shapes />
      {measuring.value && (
        <span role="status">
          {measured.value ? `${meters(measured.value.meters)} apart, ${meters(measured.value.vertical)} of it up` : "Choose two segments."}
        </span>
      )}
    </div>
  );
}

function Shapes() {
  const shown = shapesShown.value;
  if (!shown) return null;
  const { inView, chosen, drawn } = shown;
  if (drawn < chosen) return <span role="status">Loading shapes: {drawn} of {chosen}.</span>;
  if (chosen < inView) return <span role="status">Zoom in to see all shapes: {chosen} of {count(inView)} are drawn.</span>;
  return <span role="status">{count(drawn)} {drawn === 1 ? "shape" : "shapes"}</span>;
}

function Legend() {
  if (!legend.value.length) return null;
  const kinds = !changesShown.value && (colorBy.value === "robot" || colorBy.value === "origin" || colorBy.value === "class");
  const toggle = (label: string): void => {
    const next = new Set(hiddenKinds.value);
    if (!next.delete(label)) next.add(label);
    hiddenKinds.value = next;
    recolor();
  };
  return (
    <ul class="legend" aria-label={`Colors: ${COLOR_NAMES[colorBy.value]}`}>
      {legend.value.slice(0, 14).map(({ color, label }) => (
        <li key={label}>
          <Swatch color={color} />
          {kinds ? (
            <button type="button" class="plain" aria-pressed={!hiddenKinds.value.has(label)} title="Gray or colored" onClick={() => toggle(label)}>{label}</button>
          ) : label}
        </li>
      ))}
      {legend.value.length > 14 && <li>and {legend.value.length - 14} more</li>}
    </ul>
  );
}

export function Swatch(props: { color: string }) {
  const element = useRef<HTMLSpanElement>(null);
  useEffect(() => { element.current!.style.background = props.color; }, [props.color]);
  return <span class="swatch" ref={element} aria-hidden="true" />;
}

function Compass() {
  const element = useRef<HTMLDivElement>(null);
  const place = anchor.value;
  void picture.value;
  useEffect(() => {
    const view = scene();
    if (!view) return;
    // An anchor's yaw is the heading of the map's x axis, degrees from east to north.
    const turn = view.north() + (place ? (place.yaw_deg * Math.PI) / 180 : 0);
    element.current!.style.transform = `rotate(${turn}rad)`;
  });
  return (
    <div class="compass" title={place ? "North" : "The map's y axis. A map with a WGS84 anchor shows north."}>
      <div ref={element}><i aria-hidden="true">▲</i><b>{place ? "N" : "y"}</b></div>
    </div>
  );
}

function Scale(props: { pointer: [number, number] | null }) {
  const bar = useRef<HTMLDivElement>(null);
  const view = scene();
  void picture.value;
  const perPixel = view ? view.scale() : 1;
  const power = 10 ** Math.floor(Math.log10(Math.max(perPixel * 110, 1e-6)));
  const length = [5, 2, 1].map((step) => step * power).find((each) => each <= perPixel * 110) ?? power;
  useEffect(() => { bar.current!.style.width = `${Math.round(length / perPixel)}px`; });
  const layer = view && current.value ? view.layers.get(current.value) : undefined;
  const place = view && props.pointer ? view.ground(...props.pointer) : null;
  const inMap = place && layer ? place.applyMatrix4(layer.pose.invert()) : place;
  const earth = inMap && anchor.value ? toWgs84(anchor.value, inMap.x, inMap.y) : null;
  return (
    <div class="scale">
      <div ref={bar} class="bar" />
      <span>{length >= 1000 ? `${length / 1000} km` : `${Number(length.toPrecision(1))} m`}</span>
      {view && view.total > 0 && <span class="count">{view.drawn < view.total ? `${count(view.drawn)} of ` : ""}{count(view.total)} segments</span>}
      {inMap && <span class="place">x {inMap.x.toFixed(1)}, y {inMap.y.toFixed(1)}</span>}
      {earth && <span class="place">{earth.lat.toFixed(6)}, {earth.lon.toFixed(6)}</span>}
    </div>
  );
}
