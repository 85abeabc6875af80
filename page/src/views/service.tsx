// The service's own state: latency, queue and refusals over the last minutes, from its metrics.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import { api } from "../api/client";
import { key, version } from "../state/store";
import { mayDo } from "./key";
import { count } from "./parts";

const STEP_SECONDS = 2;
const KEPT = 300;

interface Sample {
  time: number;
  requests: number;
  seconds: number;
  slow: number;
  queue: number;
  refused: number;
}

interface Totals {
  requests: number;
  seconds: number;
  buckets: Map<number, number>;
  refused: number;
  queue: number;
  maps: number;
  segments: number;
}

const samples = signal<Sample[]>([]);
const totals = signal<Totals | null>(null);
const ROUTES = /route="\/(describe|match|localize)"/;

/** Sum the metrics of the recognition routes. */
export function parseMetrics(text: string): Totals {
  const found: Totals = { requests: 0, seconds: 0, buckets: new Map(), refused: 0, queue: 0, maps: 0, segments: 0 };
  for (const line of text.split("\n")) {
    if (!line || line.startsWith("#")) continue;
    const space = line.lastIndexOf(" ");
    const [name, value] = [line.slice(0, space), Number(line.slice(space + 1))];
    if (name.startsWith("placecell_request_seconds_count{") && ROUTES.test(name)) found.requests += value;
    else if (name.startsWith("placecell_request_seconds_sum{") && ROUTES.test(name)) found.seconds += value;
    else if (name.startsWith("placecell_request_seconds_bucket{") && ROUTES.test(name)) {
      const limit = Number(/le="([^"]+)"/.exec(name)![1]!.replace("+Inf", "Infinity"));
      found.buckets.set(limit, (found.buckets.get(limit) ?? 0) + value);
    } else if (name.startsWith("placecell_rejected_total")) found.refused += value;
    else if (name === "placecell_queue_requests") found.queue = value;
    else if (name === "placecell_maps") found.maps = value;
    else if (name === "placecell_map_segments") found.segments = value;
  }
  return found;
}

/** Upper edge of the bucket that holds the slowest hundredth of the new requests, ms. */
function slowest(now: Totals, before: Totals): number {
  const requests = now.requests - before.requests;
  for (const limit of [...now.buckets.keys()].sort((a, b) => a - b)) {
    if (now.buckets.get(limit)! - (before.buckets.get(limit) ?? 0) >= 0.99 * requests) return 1000 * limit;
  }
  return Infinity;
}

async function sample(): Promise<void> {
  const text = await api.metrics().catch(() => null);
  if (text === null) return;
  const now = parseMetrics(text);
  const before = totals.value;
  totals.value = now;
  if (!before || now.requests < before.requests) return;
  const requests = now.requests - before.requests;
  samples.value = [...samples.value.slice(1 - KEPT), {
    time: Date.now() / 1000, requests: requests / STEP_SECONDS,
    seconds: requests ? (1000 * (now.seconds - before.seconds)) / requests : NaN, slow: requests ? slowest(now, before) : NaN,
    queue: now.queue, refused: (now.refused - before.refused) / STEP_SECONDS,
  }];
}

export function Service() {
  useEffect(() => {
    void sample();
    const timer = setInterval(() => void sample(), 1000 * STEP_SECONDS);
    return () => clearInterval(timer);
  }, []);
  const last = totals.value;
  return (
    <>
      <p>
        Placecell {version.value}. {last && `${count(last.maps)} maps with ${count(last.segments)} segments. ${count(last.requests)} recognition requests and ${count(last.refused)} refusals since the start.`}
      </p>
      {key.value && <p>{key.value.open ? "The service has no keys: everyone who reaches it may look at and change all maps." : mayDo(key.value)}</p>}
      {!samples.value.some((each) => each.requests > 0) && <p class="facts" role="status">No recognition request has come since this panel was opened.</p>}
      <Chart title="Latency, ms" lines={[["mean", "seconds", "#56b4e9"], ["slowest 1%, at most", "slow", "#e69f00"]]} />
      <Chart title="Requests waiting or in work" lines={[["queue", "queue", "#009e73"]]} />
      <Chart title="Requests a second" lines={[["requests", "requests", "#56b4e9"], ["refused", "refused", "#d55e00"]]} />
      <p><a href="docs" target="_blank" rel="noopener">API documentation</a></p>
    </>
  );
}

function Chart(props: { title: string; lines: [string, keyof Sample, string][] }) {
  const element = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const data = (): uPlot.AlignedData => [
    samples.value.map((each) => each.time),
    ...props.lines.map(([, field]) => samples.value.map((each) => (Number.isFinite(each[field]) ? each[field] : null))),
  ];
  useEffect(() => {
    const axis = { stroke: "#b6c2cc", grid: { stroke: "#2a3947" }, ticks: { stroke: "#2a3947" } };
    const made = new uPlot({
      width: element.current!.clientWidth, height: 120, cursor: { show: false }, legend: { show: true, live: false },
      scales: { y: { range: (_plot, _low, high) => [0, Math.max(high, 1)] } },
      axes: [axis, { ...axis, size: 44 }],
      series: [{}, ...props.lines.map(([label, , stroke], index) => ({ label, stroke, width: 2, ...(index ? { dash: [6, 4] } : {}), spanGaps: true }))],
    }, data(), element.current!);
    plot.current = made;
    const box = element.current!;
    const watch = new ResizeObserver(() => made.setSize({ width: box.clientWidth, height: 120 }));
    watch.observe(box);
    return () => { watch.disconnect(); made.destroy(); };
  }, []);
  const state = samples.value;
  useEffect(() => plot.current?.setData(data()), [state]);
  return <figure><figcaption>{props.title}</figcaption><div ref={element} /></figure>;
}
