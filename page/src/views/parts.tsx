// Small parts that several views use.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { RobotState } from "../api/types";

/** A button. A disabled one keeps the focus, so that a key press does not lose its place. */
export function Button(props: {
  children: ComponentChildren; onClick: () => void; disabled?: boolean; pressed?: boolean; title?: string; label?: string; kind?: "danger" | "plain" | "main";
}) {
  return (
    <button
      type="button" class={props.kind ?? ""} aria-disabled={props.disabled ?? false} title={props.title ?? ""} aria-label={props.label}
      aria-pressed={props.pressed} onClick={() => { if (!props.disabled) props.onClick(); }}
    >
      {props.children}
    </button>
  );
}

/** A dialog that keeps the keyboard inside; Escape closes it. */
export function Dialog(props: { title: string; onClose?: () => void; children: ComponentChildren }) {
  const element = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const dialog = element.current!;
    const before = document.activeElement;
    if (!dialog.open) dialog.showModal();
    return () => {
      dialog.close();
      // The browser cannot give the focus back, because the dialog is removed while it closes.
      setTimeout(() => { if (before instanceof HTMLElement && before.isConnected) before.focus(); });
    };
  }, []);
  const cancel = (event: Event): void => {
    event.preventDefault();
    props.onClose?.();
  };
  return (
    <dialog ref={element} aria-label={props.title} onCancel={cancel}>
      <h2>{props.title}</h2>
      {props.children}
    </dialog>
  );
}

export function FileButton(props: { label: string; accept?: string; onFile: (file: File) => void }) {
  const input = useRef<HTMLInputElement>(null);
  const take = (): void => {
    const file = input.current?.files?.[0];
    if (file) props.onFile(file);
    if (input.current) input.current.value = "";
  };
  return (
    <>
      <Button onClick={() => input.current?.click()}>{props.label}</Button>
      <input ref={input} type="file" class="hidden" aria-label={props.label} tabIndex={-1} accept={props.accept ?? ""} onChange={take} />
    </>
  );
}

export const count = (value: number): string => value.toLocaleString("en-US");

export function bytes(value: number): string {
  if (value < 1e6) return `${(value / 1e3).toFixed(1)} kB`;
  return value < 1e9 ? `${(value / 1e6).toFixed(1)} MB` : `${(value / 1e9).toFixed(2)} GB`;
}

export function ago(seconds: number): string {
  if (seconds < 90) return `${Math.max(0, Math.round(seconds))} s ago`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min ago`;
  return seconds < 129_600 ? `${Math.round(seconds / 3600)} h ago` : `${Math.round(seconds / 86_400)} days ago`;
}

/** A number with so many digits after the point; zero has no sign. */
const fixed = (value: number, digits: number): string => value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1");
export const meters = (value: number): string => `${fixed(value, Math.abs(value) < 10 ? 2 : 1)} m`;
export const degrees = (radians: number): string => `${fixed((radians * 180) / Math.PI, 1)}°`;
export const percent = (share: number): string => `${(100 * share).toFixed(share > 0.99 && share < 1 ? 1 : 0)}%`;

/** Whether a robot has no pose now: its last report had none. Both ages are of one moment. */
export const isLost = (robot: RobotState): boolean => robot.map === null || robot.pose_age === null || robot.pose_age > robot.age;
