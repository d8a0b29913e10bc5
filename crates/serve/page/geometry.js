// The shape of an arm as lines, m, from the stations of an answer.

/** @import { Drawing, Outline, Point, Silhouette, Stations } from "./types" */

/**
 * Surface r +- beta R b, centreline and cables r + y beta b.
 * @param {Stations} st
 * @param {Drawing} drawing
 * @returns {Outline}
 */
export function outlineOf(st, drawing) {
  const place = (/** @type {number} */ i, /** @type {number} */ distance) =>
    /** @type {Point} */ ([st.x[i] - distance * Math.sin(st.theta[i]), st.y[i] + distance * Math.cos(st.theta[i])]);
  const left = st.s.map((_, i) => place(i, st.beta[i] * drawing.radius[i]));
  const right = st.s.map((_, i) => place(i, -st.beta[i] * drawing.radius[i]));
  const centre = st.s.map((_, i) => place(i, 0));
  const cables = drawing.offsets.map((offsets) => offsets.map((y, i) => place(i, st.beta[i] * y)));
  return { left, right, centre, cables };
}

/**
 * @param {Silhouette} shape
 * @returns {Outline}
 */
export function outlineOfSilhouette(shape) {
  const place = (/** @type {number} */ i, /** @type {number} */ side) => {
    const distance = side * shape.half_width[i];
    return /** @type {Point} */ ([shape.x[i] - distance * Math.sin(shape.theta[i]), shape.y[i] + distance * Math.cos(shape.theta[i])]);
  };
  const all = (/** @type {number} */ side) => shape.x.map((_, i) => place(i, side));
  return { left: all(1), right: all(-1), centre: all(0), cables: [] };
}

/**
 * Least and greatest x and y.
 * @param {Point[][]} lines
 * @returns {{ x: Point, y: Point }}
 */
export function boundsOf(lines) {
  /** @type {{ x: Point, y: Point }} */
  const b = { x: [Infinity, -Infinity], y: [Infinity, -Infinity] };
  for (const [x, y] of lines.flat()) {
    b.x = [Math.min(b.x[0], x), Math.max(b.x[1], x)];
    b.y = [Math.min(b.y[0], y), Math.max(b.y[1], y)];
  }
  return b;
}

/**
 * The station nearest to a point, and how far that is (m).
 * @param {Point[]} centre
 * @param {Point} point
 */
export function nearest(centre, [x, y]) {
  let index = 0;
  let distance = Infinity;
  centre.forEach(([cx, cy], i) => {
    const d = Math.hypot(cx - x, cy - y);
    if (d < distance) [index, distance] = [i, d];
  });
  return { index, distance };
}

/**
 * The station nearest to a place along the arm.
 * @param {number[]} s
 * @param {number} place
 */
export function stationAt(s, place) {
  let best = 0;
  for (let i = 1; i < s.length; i += 1) if (Math.abs(s[i] - place) < Math.abs(s[best] - place)) best = i;
  return best;
}
