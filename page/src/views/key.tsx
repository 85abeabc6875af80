// Asks for a key once, where the service has keys. The tab keeps it; nothing else does.
import { useState } from "preact/hooks";
import { needsKey, signIn } from "../state/store";
import { Dialog } from "./parts";

export function KeyDialog() {
  const [typed, setTyped] = useState("");
  const [busy, setBusy] = useState(false);
  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    setBusy(true);
    await signIn(typed.trim());
    setBusy(false);
  };
  return (
    <Dialog title="Key">
      <form onSubmit={(event) => void submit(event)}>
        <p>This service needs a key. A key to read is enough to look; the operator of the service makes it with <code>placecell keys</code>.</p>
        <label>Key <input type="password" autocomplete="off" required value={typed} onInput={(event) => setTyped(event.currentTarget.value)} /></label>
        {needsKey.value && <p role="alert">{needsKey.value}</p>}
        <div class="row"><button type="submit" class="main" disabled={busy}>Sign in</button></div>
      </form>
    </Dialog>
  );
}
