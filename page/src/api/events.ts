// Server-sent events over fetch: EventSource cannot send a key.
import { ApiError, send } from "./client";

export interface ServiceEvent {
  id: string;
  kind: string;
  data: Record<string, unknown>;
}

/** Read events until the signal; connect again after a break, from the last event on. */
export async function follow(
  signal: AbortSignal,
  onEvent: (event: ServiceEvent) => void,
  onState: (connected: boolean, reason: string) => void,
): Promise<void> {
  let last = "";
  let pause = 1;
  while (!signal.aborted) {
    try {
      const headers: Record<string, string> = { Accept: "text/event-stream" };
      if (last) headers["Last-Event-ID"] = last;
      const answer = await send("events", { headers, signal });
      onState(true, "");
      pause = 1;
      for await (const event of parse(answer.body!)) {
        if (event.id) last = event.id;
        if (event.kind) onEvent(event);
      }
      onState(false, "The service closed the stream.");
    } catch (error) {
      if (signal.aborted) return;
      onState(false, error instanceof Error ? error.message : String(error));
      if (error instanceof ApiError && (error.status === 401 || error.status === 404)) return;
      pause = Math.min(30, 2 * pause);
    }
    await new Promise((done) => setTimeout(done, 1000 * pause));
  }
}

async function* parse(stream: ReadableStream<Uint8Array>): AsyncGenerator<ServiceEvent> {
  const reader = stream.getReader();
  const decoder = new TextDecoder();
  let rest = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    rest += decoder.decode(value, { stream: true });
    const blocks = rest.replaceAll("\r\n", "\n").split("\n\n");
    rest = blocks.pop() ?? "";
    for (const block of blocks) {
      const event: ServiceEvent = { id: "", kind: "", data: {} };
      const data: string[] = [];
      for (const line of block.split("\n")) {
        const colon = line.indexOf(":");
        if (colon < 1) continue;
        const value = line.slice(colon + 1).replace(/^ /, "");
        const field = line.slice(0, colon);
        if (field === "id") event.id = value;
        if (field === "event") event.kind = value;
        if (field === "data") data.push(value);
      }
      if (data.length) event.data = JSON.parse(data.join("\n")) as Record<string, unknown>;
      yield event;
    }
  }
}
