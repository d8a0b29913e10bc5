// The shape of an arm as lines, m, from the stations of an answer.

/** @import { Body, Drawing, Outline, Point, Silhouette, Solution, Stations } from "./types" */

import { bodyInSpace, bodyOfSilhouette } from "./solid.js";

/** What draws an answer, from wherever it is seen. @param {Solution} shape @param {Drawing} drawing @returns {Body} */
export function bodyOf(shape, drawing) {
  if (shape.stations.z) return bodyInSpace(shape, drawing);
  const outline = outlineOf(shape.stations, drawing);
  return () => outline;
}

/** @param {Silhouette} shape @returns {Body} */
export function bodyOfShape(shape) {
  if (shape.z) return bodyOfSilhouette(shape);
  const outline = outlineOfSilhouette(shape);
  return () => outline;
}

/**
 * Surface r +- beta R b, centreline and cables r + y beta b.
 * @param {Stations} st
 * @param {Drawing} drawing
 * @returns {Outline}
 */
function outlineOf(st, drawing) {
  const { theta = [] } = st;
  const place = (/** @type {number} */ i, /** @type {number} */ distance) =>
    /** @type {Point} */ ([st.x[i] - distance * Math.sin(theta[i]), st.y[i] + distance * Math.cos(theta[i])]);
  const left = st.s.map((_, i) => place(i, st.beta[i] * drawing.radius[i]));
  const right = st.s.map((_, i) => place(i, -st.beta[i] * drawing.radius[i]));
  const centre = st.s.map((_, i) => place(i, 0));
  const cables = drawing.offsets.map((offsets) => offsets.map((y, i) => place(i, st.beta[i] * y)));
  return { left, right, centre, cables, tip: inPlane(centre[centre.length - 1]) };
}

/**
 * @param {Silhouette} shape
 * @returns {Outline}
 */
function outlineOfSilhouette(shape) {
  const { theta = [] } = shape;
  const place = (/** @type {number} */ i, /** @type {number} */ side) => {
    const distance = side * shape.half_width[i];
    return /** @type {Point} */ ([shape.x[i] - distance * Math.sin(theta[i]), shape.y[i] + distance * Math.cos(theta[i])]);
  };
  const all = (/** @type {number} */ side) => shape.x.map((_, i) => place(i, side));
  const centre = all(0);
  return { left: all(1), right: all(-1), centre, cables: [], tip: inPlane(centre[centre.length - 1]) };
}

/** A point of the plane as a place in space. @param {Point} point @returns {import("./types").Place} */
const inPlane = ([x, y]) => [x, y, 0];

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
