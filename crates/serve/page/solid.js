// A shape in space as it is seen: rings of its surface, its outline and its cables on the page, m.

/** @import { Body, Drawing, Outline, Patch, Place, Point, Silhouette, Solution } from "./types" */
/** @import { Camera } from "./camera.js" */

import { cross, dot, flat, plus, unit } from "./camera.js";

/** Patches around a ring. */
const AROUND = 18;
/** Rings of the surface. */
const RINGS = 60;
/** Where the light comes from: over the left shoulder of whoever looks. @type {Place} */
const LIGHT = unit([-0.4, 0.6, 0.75]);

/**
 * What is drawn of a shape: sections with two directions across, and cables.
 * @typedef {{ centre: Place[], b: Place[], c: Place[], radius: number[], cables: Place[][] }} Solid
 */

/**
 * Of an answer: cables at r + beta (y b + z c).
 * @param {Solution} shape
 * @param {Drawing} drawing
 * @returns {Body}
 */
export function bodyInSpace({ stations: st }, drawing) {
  const { z = [], b = [], c = [] } = st;
  const centre = st.s.map((_, i) => /** @type {Place} */ ([st.x[i], st.y[i], z[i]]));
  const cables = drawing.offsets.map((offsets, k) => offsets.map((y, i) => {
    const across = drawing.offsets_c?.[k][i] ?? 0;
    return plus(plus(centre[i], st.beta[i] * y, b[i]), st.beta[i] * across, c[i]);
  }));
  const solid = { centre, b, c, radius: st.beta.map((beta, i) => beta * drawing.radius[i]), cables };
  return (camera) => seen(solid, camera);
}

/** @param {Silhouette} shape @returns {Body} */
export function bodyOfSilhouette(shape) {
  const { a = [], z = [] } = shape;
  const centre = shape.x.map((x, i) => /** @type {Place} */ ([x, shape.y[i], z[i]]));
  // Any two directions across do.
  const b = a.map((normal) => unit(cross(Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], normal)));
  const solid = { centre, b, c: a.map((normal, i) => cross(normal, b[i])), radius: shape.half_width, cables: [] };
  return (camera) => seen(solid, camera);
}

/**
 * @param {Solid} solid
 * @param {Camera} camera
 * @returns {Outline}
 */
function seen(solid, camera) {
  const { centre, b, c, radius } = solid;
  /** The widest direction of a section on the page: across the normal that is seen. @type {Place} */
  let across = camera.up;
  const sides = centre.map((_, i) => {
    const found = cross(camera.back, cross(b[i], c[i]));
    if (Math.hypot(...found) > 1e-6) across = unit(found);
    return across;
  });
  const side = (/** @type {number} */ sign) => centre.map((place, i) => flat(camera, plus(place, sign * radius[i], sides[i])));
  return {
    left: side(1), right: side(-1), centre: centre.map((place) => flat(camera, place)),
    cables: solid.cables.map((line) => line.map((place) => flat(camera, place))),
    tip: centre[centre.length - 1],
    space: {
      patches: () => patches(solid, camera),
      ring: (i, wider = 1) => Array.from({ length: AROUND + 1 }, (_, k) => flat(camera, around(solid, i, k, wider))),
      arc: (i) => arc(solid, camera, i),
      hidden: solid.cables.map((line) => line.map((place, i) => dot(place, camera.back) < dot(centre[i], camera.back))),
    },
  };
}

/** @param {Solid} solid @param {number} i @param {number} k @param {number} [wider] */
function around({ centre, b, c, radius }, i, k, wider = 1) {
  const phi = (2 * Math.PI * k) / AROUND;
  return plus(plus(centre[i], wider * radius[i] * Math.cos(phi), b[i]), wider * radius[i] * Math.sin(phi), c[i]);
}

/** The part of a section's edge that faces whoever looks. @param {Solid} solid @param {Camera} camera @param {number} i */
function arc(solid, camera, i) {
  const faces = Array.from({ length: AROUND }, (_, k) => dot(plus(around(solid, i, k), -1, solid.centre[i]), camera.back) > 0);
  const first = faces.findIndex((face, k) => face && !faces[(k + AROUND - 1) % AROUND]);
  /** @type {Point[]} */
  const points = [];
  if (first < 0) return points;
  for (let k = first; k < first + AROUND && faces[k % AROUND]; k += 1) points.push(flat(camera, around(solid, i, k)));
  return points;
}

/**
 * The parts of the surface that face whoever looks, the furthest first, each with its light.
 * @param {Solid} solid
 * @param {Camera} camera
 */
function patches(solid, camera) {
  const { centre, b, c } = solid;
  const light = plus(plus([0, 0, 0], LIGHT[0], camera.right), LIGHT[1], camera.up);
  const sun = plus(light, LIGHT[2], camera.back);
  const last = centre.length - 1;
  const rings = Array.from({ length: Math.min(RINGS, last) + 1 }, (_, r) => Math.round((r * last) / Math.min(RINGS, last)));
  /** @type {(Patch & { depth: number })[]} */
  const found = [];
  for (let r = 0; r + 1 < rings.length; r += 1) {
    const [i, j] = [rings[r], rings[r + 1]];
    for (let k = 0; k < AROUND; k += 1) {
      const corners = [around(solid, i, k), around(solid, i, k + 1), around(solid, j, k + 1), around(solid, j, k)];
      const phi = (2 * Math.PI * (k + 0.5)) / AROUND;
      /** @type {Place} */
      const out = plus(plus([0, 0, 0], Math.cos(phi), b[i]), Math.sin(phi), c[i]);
      if (dot(out, camera.back) < -0.02) continue;
      found.push({
        corners: corners.map((place) => flat(camera, place)), station: i, light: Math.max(0, dot(out, sun)),
        depth: dot(corners[0], camera.back) + dot(corners[2], camera.back),
      });
    }
  }
  // The disc at an end that is seen.
  for (const [i, sign] of /** @type {[number, number][]} */ ([[0, -1], [last, 1]])) {
    const normal = cross(b[i], c[i]);
    const facing = sign * dot(normal, camera.back);
    if (facing <= 0) continue;
    const corners = Array.from({ length: AROUND }, (_, k) => flat(camera, around(solid, i, k)));
    found.push({ corners, station: i, light: Math.max(0, sign * dot(normal, sun)), depth: 2 * dot(centre[i], camera.back) });
  }
  return found.sort((p, q) => p.depth - q.depth);
}

/** The direction of the centreline in that of the page. @param {Solution} shape @param {number} i @returns {Place} */
export function tangent({ stations: st }, i) {
  const { a = [], b = [], c = [], zeta = [] } = st;
  return unit(plus(plus(plus([0, 0, 0], st.nu[i], a[i]), st.eta[i], b[i]), zeta[i], c[i]));
}
