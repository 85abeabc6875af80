// Colors that people with color blindness can tell apart: Okabe and Ito's palette for kinds, and
// "cividis" for amounts.

export type Color = readonly [number, number, number];

const hex = (code: number): Color => [(code >> 16) / 255, ((code >> 8) & 255) / 255, (code & 255) / 255];

const OKABE_ITO = [0x56b4e9, 0xe69f00, 0x009e73, 0xf0e442, 0xd55e00, 0xcc79a7, 0x0072b2, 0xbbbbbb].map(hex);
const CIVIDIS = [0x00224e, 0x123570, 0x3b496c, 0x575d6d, 0x707173, 0x8a8678, 0xa59c74, 0xc3b369, 0xe1cc55, 0xfee838].map(hex);

export const GRAY: Color = hex(0x66727d);
export const ADDED: Color = hex(0x56b4e9);
/** Color of the segments that a version did not change, while its changes are shown. */
export const UNCHANGED: Color = hex(0x3a4650);
export const REMOVED: Color = hex(0xd55e00);
export const SELECTED: Color = hex(0xffffff);
export const FIX: Color = hex(0xf0e442);

/** Color of the i-th of several kinds; from the ninth on, darker ones of the same hues. */
export function kindColor(index: number): Color {
  const [red, green, blue] = OKABE_ITO[index % OKABE_ITO.length]!;
  const shade = [1, 0.7, 0.5][Math.floor(index / OKABE_ITO.length) % 3]!;
  return [red * shade, green * shade, blue * shade];
}

/** Color of an amount from 0 to 1. */
export function amountColor(amount: number): Color {
  const place = Math.min(Math.max(amount, 0), 1) * (CIVIDIS.length - 1);
  const low = Math.min(Math.floor(place), CIVIDIS.length - 2);
  const [a, b] = [CIVIDIS[low]!, CIVIDIS[low + 1]!];
  const part = place - low;
  return [0, 1, 2].map((channel) => a[channel]! + part * (b[channel]! - a[channel]!)) as unknown as Color;
}

export const css = ([red, green, blue]: Color): string =>
  `rgb(${Math.round(255 * red)} ${Math.round(255 * green)} ${Math.round(255 * blue)})`;
