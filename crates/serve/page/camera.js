// How places in space come onto the plane of the page: along parallel lines, so that lengths across them stay true.

/** @import { Place, Point } from "./types" */

/**
 * Directions of length one: to the right and up on the page, and out of it.
 * @typedef {{ right: Place, up: Place, back: Place }} Camera
 */

/** e1 to the right, e2 up: that of every arm in the plane. @type {Camera} */
export const FRONT = { right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1] };

/** @param {Place} a @param {Place} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** @param {Place} a @param {Place} b @returns {Place} */
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** a + t b. @param {Place} a @param {number} t @param {Place} b @returns {Place} */
export const plus = (a, t, b) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];

/** @param {Place} v @returns {Place} */
export function unit(v) {
  const length = Math.hypot(...v) || 1;
  return [v[0] / length, v[1] / length, v[2] / length];
}

/** From a direction that is not along e2, which is up. @param {Place} from @returns {Camera} */
function towards(from) {
  const back = unit(from);
  const right = unit(cross([0, 1, 0], back));
  return { right, up: cross(back, right), back };
}

/** Views to choose, by name. @type {Record<string, Camera>} */
export const SIDES = {
  xy: FRONT,
  xz: { right: [1, 0, 0], up: [0, 0, 1], back: [0, -1, 0] },
  yz: { right: [0, 1, 0], up: [0, 0, 1], back: [1, 0, 0] },
  // From where the drawings of the program have their eye.
  "3D": towards([0.4, 0.5, 1]),
};

/** The direction that a file gives, by an angle (deg) or by its parts. @param {import("./types").Direction} direction @returns {Place} */
export function directionOf(direction) {
  if (typeof direction !== "number") return unit(direction);
  const psi = (direction * Math.PI) / 180;
  // What rounding leaves of a right angle is nothing.
  const clean = (/** @type {number} */ v) => (Math.abs(v) < 1e-12 ? 0 : v);
  return [clean(Math.cos(psi)), clean(Math.sin(psi)), 0];
}

/** @param {Camera} camera @param {Place} place @returns {Point} */
export const flat = ({ right, up }, place) => [dot(place, right), dot(place, up)];

/** The place at a point of the page, as near to whoever looks as `like`. @param {Camera} camera @param {Point} point @param {Place} like */
export function placeAt(camera, [x, y], like) {
  const [own, height] = flat(camera, like);
  return plus(plus(like, x - own, camera.right), y - height, camera.up);
}

/**
 * Turned about the page's upward direction and about its direction to the right, rad: what is seen turns that way.
 * @param {Camera} camera
 * @param {number} about up
 * @param {number} tilt
 * @returns {Camera}
 */
export function turned({ right, up, back }, about, tilt) {
  const [c, s] = [Math.cos(about), Math.sin(about)];
  const side = unit(plus([c * right[0], c * right[1], c * right[2]], s, back));
  const out = unit(cross(side, up));
  const [ct, st] = [Math.cos(tilt), Math.sin(tilt)];
  const over = unit(plus([ct * up[0], ct * up[1], ct * up[2]], -st, out));
  return { right: side, up: over, back: unit(cross(side, over)) };
}
