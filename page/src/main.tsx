// The operator's page: maps, robots, a scan's place, and the service's own state.
import "uplot/dist/uPlot.min.css";
import "./page.css";
import { render } from "preact";
import { useEffect } from "preact/hooks";
import { connected, dismiss, key, messages, needsKey, selection, signOut, tab, type Tab } from "./state/store";
import { KeyDialog, mayDo, roleOf } from "./views/key";
import { Locate } from "./views/locate";
import { Maps, takeFile, upload, UploadDialog } from "./views/maps";
import { Button } from "./views/parts";
import { RobotDrawer, Robots } from "./views/robots";
import { SegmentCard } from "./views/segment";
import { Service } from "./views/service";
import { Stage } from "./views/stage";

const TABS: Record<Tab, [string, () => preact.JSX.Element]> = {
  maps: ["Maps", Maps], robots: ["Robots", Robots], locate: ["Locate a scan", Locate], service: ["Service", Service],
};

function App() {
  useEffect(() => {
    const over = (event: DragEvent): void => event.preventDefault();
    const drop = (event: DragEvent): void => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file) void takeFile(file);
    };
    addEventListener("dragover", over);
    addEventListener("drop", drop);
    return () => { removeEventListener("dragover", over); removeEventListener("drop", drop); };
  }, []);
  const [, Panel] = TABS[tab.value];
  return (
    <>
      <header class="bar">
        <h1>Placecell</h1>
        <span class={connected.value.on ? "state on" : "state"} role="status">{connected.value.on ? "connected" : "not connected"}</span>
        {key.value && !key.value.open && (
          <span class="who" title={mayDo(key.value)}>{key.value.name} ({roleOf(key.value)}) <Button kind="plain" onClick={signOut}>Sign out</Button></span>
        )}
      </header>
      <nav aria-label="Panels">
        {Object.entries(TABS).map(([name, [label]]) => (
          <Button key={name} pressed={tab.value === name} onClick={() => (tab.value = name as Tab)}>{label}</Button>
        ))}
      </nav>
      <main class="panel"><Panel /></main>
      <Stage />
      {selection.value && <SegmentCard />}
      <RobotDrawer />
      <div class="messages" aria-live="assertive">
        {messages.value.map((message) => (
          <div key={message.id} class={message.kind} role={message.kind === "error" ? "alert" : "status"}>
            <div><b>{message.text}</b>{message.detail && <span>{message.detail}</span>}</div>
            <Button kind="plain" onClick={() => dismiss(message.id)}>Close</Button>
          </div>
        ))}
      </div>
      {upload.value && <UploadDialog />}
      {needsKey.value !== null && <KeyDialog />}
    </>
  );
}

document.body.replaceChildren();
render(<App />, document.body);
