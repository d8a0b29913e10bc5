// Numbers as people read them.

/**
 * A number with about `digits` digits that matter, with a proper minus sign.
 * @param {number | null | undefined} value
 * @param {number} [digits]
 */
export function number(value, digits = 5) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(2) : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "\u2212");
}

/**
 * A number with a fixed count of decimals.
 * @param {number | null | undefined} value
 * @param {number} decimals
 */
export function fixed(value, decimals) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "\u2212");
}

/** @param {number} rad */
export const degrees = (rad) => (rad * 180) / Math.PI;

/**
 * A force in N, mN or kN, whatever reads best.
 * @param {number} newton
 */
export function force(newton) {
  const [factor, unit] = forceUnit(Math.abs(newton));
  return `${number(newton * factor, 4)} ${unit}`;
}

/**
 * The unit for forces of this size, and how many of it are a newton.
 * @param {number} newton
 * @returns {[number, string]}
 */
export function forceUnit(newton) {
  if (newton !== 0 && newton < 0.2) return [1e3, "mN"];
  return newton >= 2000 ? [1e-3, "kN"] : [1, "N"];
}

/**
 * The next of 1, 2, 5, 10, ... that is not below `value`.
 * @param {number} value
 */
export function roundUp(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  const step = [1, 1.5, 2, 3, 5, 7.5, 10].find((s) => s * power >= value * (1 - 1e-9)) ?? 10;
  return Number((step * power).toPrecision(3));
}

/** A number that needs no more digits than a reader does. @param {number} value */
export const plain = (value) => number(Number(value.toPrecision(4)), 4);

/**
 * Round values in a range, about `count` of them, with their labels.
 * @param {number} from
 * @param {number} to
 * @param {number} count
 */
export function ticks(from, to, count) {
  const size = 10 ** Math.floor(Math.log10((to - from) / count));
  const off = (/** @type {number} */ factor) => Math.abs((to - from) / (factor * size) - count);
  const step = size * [1, 2, 5, 10].reduce((best, factor) => (off(factor) < off(best) ? factor : best));
  const decimals = Math.min(Math.max(0, -Math.floor(Math.log10(step * 1.000001))), 12);
  const found = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step && found.length < 50; k += 1) {
    const value = k * step;
    const large = Math.abs(value) >= 1e5 || decimals > 5;
    found.push({ value, label: value === 0 ? "0" : large ? number(value, 3) : fixed(value, decimals) });
  }
  return found;
}
