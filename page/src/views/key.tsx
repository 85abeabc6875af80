// Asks for a key once, where the service has keys. The tab keeps it; nothing else does.
import { useState } from "preact/hooks";
import type { KeyInfo } from "../api/types";
import { needsKey, signIn } from "../state/store";
import { Dialog } from "./parts";

/** Role of a key in a word or two. */
export function roleOf(key: KeyInfo): string {
  if (key.robot !== null) return `robot ${key.robot}`;
  return key.may_write ? key.role : "read only";
}

/** Sentences that say what a key may do, and what to do if that is not enough. */
export function mayDo(key: KeyInfo): string {
  const maps = key.maps.includes("*") ? "all maps" : `the maps ${key.maps.join(", ")}`;
  if (key.robot !== null) {
    return `You may look at ${maps} and locate scans. The key belongs to robot ${key.robot}: it writes this robot's segments and no whole maps.`;
  }
  if (!key.may_write) {
    return `You may look at ${maps}, locate scans, compare and download maps. You may not change, merge or upload maps. `
      + "For this, sign in with a key from: placecell keys NAME --write";
  }
  return `You may look at and change ${maps}.`;
}

export function KeyDialog() {
  const [typed, setTyped] = useState("");
  const [busy, setBusy] = useState(false);
  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    if (busy) return;
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
        <div class="row"><button type="submit" class="main" aria-disabled={busy}>Sign in</button></div>
      </form>
    </Dialog>
  );
}
