// Paints a scene on a canvas: arm, cables, stream, ghost, trail. Lengths are in m, y up, and drawn true to scale.

/** @import { Body, Outline, Place, Point, Shown, Solution } from "./types" */
/** @import { Camera } from "./camera.js" */

import { directionOf, dot, flat } from "./camera.js";
import { degrees, fixed, force } from "./numbers.js";
import { tangent } from "./solid.js";

/**
 * What there is to paint.
 * @typedef {{
 *   shown: Shown | undefined,
 *   ghost: Body | undefined,
 *   pins: { body: Body, colour: number }[],
 *   extra: Body | undefined,
 *   trail: Place[],
 *   way: { place: Place, stable: boolean, event: string | null }[],
 *   target: Place | undefined,
 *   hover: number | undefined,
 *   layers: Record<string, boolean>,
 *   tints: "plain" | "alpha" | "eta" | "nu",
 * }} Scene
 */

/**
 * From m on the plane of the page to pixels: x = ox + k x, y = oy - k y.
 * @typedef {{ k: number, ox: number, oy: number, width: number, height: number, camera: Camera }} View
 */

/** How many colours the palette has for shares from 0 to 1. */
const SHADES = 5;
/** The edge of the picture that gravity's arrow keeps to, px. */
const CORNER = 34;

const FONT = '12px system-ui, "Noto Sans", "Liberation Sans", sans-serif';

/** Colours by name, from the style sheet as it is now. */
export function colours() {
  const style = getComputedStyle(document.documentElement);
  /** @type {Map<string, string>} */
  const known = new Map();
  return (/** @type {string} */ name) => {
    let colour = known.get(name);
    if (colour === undefined) {
      colour = style.getPropertyValue(`--${name}`).trim();
      known.set(name, colour);
    }
    return colour;
  };
}

export class Painter {
  /**
   * @param {CanvasRenderingContext2D} ctx
   * @param {View} view
   * @param {Scene} scene
   * @param {(name: string) => string} colour
   */
  constructor(ctx, view, scene, colour) {
    this.ctx = ctx;
    this.view = view;
    this.scene = scene;
    this.colour = colour;
  }

  paint() {
    const { ctx, view, scene } = this;
    ctx.clearRect(0, 0, view.width, view.height);
    ctx.lineJoin = "round";
    ctx.lineCap = "round";
    ctx.font = FONT;
    ctx.fillStyle = this.colour("water");
    ctx.fillRect(0, 0, view.width, view.height);
    const shape = scene.shown?.shape;
    if (shape && scene.layers.stream) this.stream(shape);
    if (scene.ghost && scene.layers.ghost) this.outline(scene.ghost(view.camera), this.colour("ghost"), 1, [5, 4]);
    if (scene.layers.trail) this.trail();
    this.way();
    for (const pin of scene.pins) this.outline(pin.body(view.camera), this.colour(`series-${pin.colour}`), 1.3);
    if (scene.shown) {
      if (scene.layers.layer) this.layer(scene.shown);
      this.arm(scene.shown);
      if (scene.layers.contact) this.contact(scene.shown);
      if (scene.layers.directors) this.directors(scene.shown);
    }
    if (scene.extra) this.outline(scene.extra(view.camera), this.colour("series-3"), 1.6, [7, 3]);
    if (scene.shown && scene.hover !== undefined) this.hovered(scene.shown, scene.hover);
    if (scene.shown?.drawing.crossing) this.crossing(scene.shown.drawing.crossing);
    if (scene.target) this.target(scene.target);
    this.scale();
    if (scene.shown?.outline.space) this.axes();
    if (shape && scene.layers.gravity) this.gravity(shape);
  }

  /** @param {Point} point @returns {Point} */
  at([x, y]) {
    return [this.view.ox + this.view.k * x, this.view.oy - this.view.k * y];
  }

  /** Of a place in space. @param {Place} place */
  seen(place) {
    return this.at(flat(this.view.camera, place));
  }

  /** An arrow along a direction in space, px; what points at whoever looks is a dot in a ring, what points away a cross in one.
   * @param {Point} from @param {Place} direction @param {number} length @param {string} colour @param {number} width @param {number} [back] the share that lies behind */
  along([x, y], direction, length, colour, width, back = 0) {
    const [dx, dy] = flat(this.view.camera, direction);
    const out = dot(direction, this.view.camera.back);
    const ends = [-back, 1 - back].map((t) => /** @type {Point} */ ([x + t * length * dx, y - t * length * dy]));
    if (Math.hypot(dx, dy) > 0.2) {
      this.arrow(ends[0], ends[1], colour, width);
      return ends[1];
    }
    const { ctx } = this;
    ctx.strokeStyle = ctx.fillStyle = colour;
    ctx.lineWidth = width;
    ctx.beginPath();
    ctx.arc(x, y, 5, 0, 2 * Math.PI);
    ctx.stroke();
    ctx.beginPath();
    if (out > 0) ctx.arc(x, y, 1.6, 0, 2 * Math.PI);
    else {
      for (const [sx, sy] of [[3.4, 3.4], [3.4, -3.4]]) {
        ctx.moveTo(x - sx, y - sy);
        ctx.lineTo(x + sx, y + sy);
      }
      ctx.stroke();
    }
    ctx.fill();
    return /** @type {Point} */ ([x + 10, y - 10]);
  }

  /** @param {Point[]} points */
  trace(points) {
    const { ctx } = this;
    ctx.beginPath();
    for (const point of points) ctx.lineTo(...this.at(point));
  }

  /**
   * @param {Point[]} points
   * @param {string} colour
   * @param {number} width
   * @param {number[]} [dash]
   */
  line(points, colour, width, dash = []) {
    const { ctx } = this;
    this.trace(points);
    ctx.setLineDash(dash);
    ctx.strokeStyle = colour;
    ctx.lineWidth = width;
    ctx.stroke();
    ctx.setLineDash([]);
  }

  /**
   * @param {Outline} outline
   * @param {string} colour
   * @param {number} width
   * @param {number[]} [dash]
   */
  outline(outline, colour, width, dash = []) {
    this.line([...outline.left, ...[...outline.right].reverse(), outline.left[0]], colour, width, dash);
  }

  /**
   * An arrow between two places on the page.
   * @param {Point} from
   * @param {Point} to
   * @param {string} colour
   * @param {number} width
   */
  arrow([x0, y0], [x1, y1], colour, width) {
    const { ctx } = this;
    const length = Math.hypot(x1 - x0, y1 - y0);
    if (length < 1) return;
    const head = Math.min(3 + 2.2 * width, 0.6 * length);
    const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
    ctx.strokeStyle = colour;
    ctx.fillStyle = colour;
    ctx.lineWidth = width;
    ctx.beginPath();
    ctx.moveTo(x0, y0);
    ctx.lineTo(x1 - 0.7 * head * ux, y1 - 0.7 * head * uy);
    ctx.stroke();
    ctx.beginPath();
    ctx.moveTo(x1, y1);
    ctx.lineTo(x1 - head * ux - 0.45 * head * uy, y1 - head * uy + 0.45 * head * ux);
    ctx.lineTo(x1 - head * ux + 0.45 * head * uy, y1 - head * uy - 0.45 * head * ux);
    ctx.fill();
  }

  /**
   * The free stream: rows of arrows, longer where it is faster.
   * @param {Solution} shape
   */
  stream(shape) {
    const { ctx, view } = this;
    const { speed, direction } = shape.inputs.flow;
    if (!(speed > 0)) return;
    const towards = directionOf(direction);
    const length = 12 + 34 * Math.min(1, Math.sqrt(speed));
    const step = 72;
    ctx.globalAlpha = 0.5;
    for (let j = 0; j * step < view.height + step; j += 1) {
      for (let i = 0; i * step < view.width + step; i += 1) {
        const [x, y] = [i * step + (j % 2) * 0.5 * step, j * step + 0.5 * step];
        this.along([x, y], towards, length, this.colour("stream"), 1.1, 0.5);
      }
    }
    ctx.globalAlpha = 1;
  }

  /**
   * The layer of equation (7) over the windward surface: its thickness as a band, its speeds as profiles.
   * @param {Shown} shown
   */
  layer({ shape, drawing, outline }) {
    const { ctx, view } = this;
    const { layer } = drawing;
    const { speed, layer_thickness: thickness } = shape.inputs.flow;
    const { theta } = shape.stations;
    if (!layer || !theta) return;
    const colour = this.colour("layer");
    const count = shape.stations.s.length;
    const along = (/** @type {number} */ i) => theta[i] + shape.stations.alpha[i];
    const normal = (/** @type {number} */ i) => {
      const side = layer.windward[i];
      return /** @type {Point} */ ([-side * Math.sin(along(i)), side * Math.cos(along(i))]);
    };
    const surface = (/** @type {number} */ i) => (layer.windward[i] > 0 ? outline.left[i] : outline.right[i]);
    ctx.fillStyle = colour;
    for (let i = 0; i + 1 < count; i += 1) {
      if (layer.windward[i] !== layer.windward[i + 1]) continue;
      const share = Math.abs(layer.speed[i]) / speed;
      const far = (/** @type {number} */ j) => {
        const [[x, y], [nx, ny]] = [surface(j), normal(j)];
        return /** @type {Point} */ ([x + thickness * nx, y + thickness * ny]);
      };
      ctx.globalAlpha = 0.04 + 0.16 * share;
      this.trace([surface(i), surface(i + 1), far(i + 1), far(i)]);
      ctx.fill();
    }
    ctx.globalAlpha = 1;
    // The longest arrow is as long as the layer is thick twice over, and still seen from afar.
    const longest = Math.max(2 * thickness, 16 / view.k);
    const profiles = 13;
    for (let k = 0; k < profiles; k += 1) {
      const i = Math.round(((k + 0.5) / profiles) * (count - 1));
      const phi = along(i);
      const [[x, y], [nx, ny]] = [surface(i), normal(i)];
      /** @type {Point[]} */
      const curve = [];
      const last = layer.profile.length - 1;
      layer.profile.forEach((share, j) => {
        const height = (j / last) * thickness;
        const reach = (longest * share * layer.speed[i]) / speed;
        curve.push([x + height * nx + reach * Math.cos(phi), y + height * ny + reach * Math.sin(phi)]);
      });
      this.line(curve, colour, 0.9);
      this.line([[x, y], [x + thickness * nx, y + thickness * ny]], colour, 0.5);
      this.arrow(this.at([x + thickness * nx, y + thickness * ny]), this.at(curve[last]), colour, 1);
    }
  }

  /**
   * Body, sections, centreline and cables.
   * @param {Shown} shown
   */
  arm({ shape, outline, asked }) {
    if (outline.space) this.solid(shape, outline, asked);
    else this.flatArm(shape, outline, asked);
  }

  /**
   * A shape in space: shaded patches, edges of sections, cables, paler where they are behind the centreline.
   * @param {Solution} shape
   * @param {Outline} outline
   * @param {boolean} asked
   */
  solid(shape, outline, asked) {
    const { ctx, scene } = this;
    const { space, left, cables } = outline;
    if (!space) return;
    this.trace(space.ring(0, 1.6));
    ctx.fillStyle = this.colour("section");
    ctx.globalAlpha = 0.5;
    ctx.fill();
    ctx.globalAlpha = asked ? 1 : 0.45;
    ctx.fillStyle = this.colour("body");
    const body = String(ctx.fillStyle);
    const tint = this.tint(shape);
    /** @type {Map<string, string>} */
    const known = new Map();
    ctx.lineWidth = 0.7;
    for (const { corners, station, light } of space.patches()) {
      const base = tint ? tint(station) : body;
      const level = Math.round(20 * light);
      const key = `${base} ${level}`;
      let shaded = known.get(key);
      if (shaded === undefined) known.set(key, (shaded = lit(base, level / 20)));
      ctx.fillStyle = ctx.strokeStyle = shaded;
      this.trace(corners);
      ctx.closePath();
      ctx.fill();
      if (asked) ctx.stroke();
    }
    ctx.globalAlpha = 1;
    const count = left.length - 1;
    if (scene.layers.sections) {
      for (let k = 0; k <= 40; k += 1) this.line(space.arc(Math.round((k / 40) * count)), this.colour("section"), 0.6);
    }
    if (!asked) this.outline(outline, this.colour("bad"), 1.4, [3, 3]);
    cables.forEach((line, c) => this.cable(line, c, shape, space.hidden[c], count));
  }

  /**
   * @param {Point[]} line
   * @param {number} c
   * @param {Solution} shape
   * @param {boolean[]} hidden at its points
   * @param {number} last station of the tip
   */
  cable(line, c, shape, hidden, last) {
    const { ctx } = this;
    const largest = Math.max(...shape.cables.map((cable) => cable.tension), 1e-300);
    const { tension } = shape.cables[c];
    const colour = this.colour(`series-${c % 7}`);
    const [width, dash] = tension > 0 ? [1 + 2.4 * (tension / largest), []] : [1, [4, 3]];
    for (let i = 0; i + 1 < line.length;) {
      let end = i + 1;
      while (end + 1 < line.length && hidden[end] === hidden[i]) end += 1;
      ctx.globalAlpha = hidden[i] ? 0.32 : 1;
      this.line(line.slice(i, end + 1), colour, width, dash);
      i = end;
    }
    ctx.globalAlpha = 1;
    if (line.length > 0 && line.length <= last) {
      ctx.fillStyle = colour;
      ctx.beginPath();
      ctx.arc(...this.at(line[line.length - 1]), 3, 0, 2 * Math.PI);
      ctx.fill();
    }
  }

  /**
   * @param {Solution} shape
   * @param {Outline} outline
   * @param {boolean} asked
   */
  flatArm(shape, outline, asked) {
    const { ctx, scene } = this;
    const { left, right, centre, cables } = outline;
    ctx.globalAlpha = asked ? 0.88 : 0.45;
    if (scene.tints === "plain") {
      this.trace([...left, ...[...right].reverse()]);
      ctx.fillStyle = this.colour("body");
      ctx.fill();
    } else {
      this.tinted(shape, outline);
    }
    ctx.globalAlpha = 1;
    if (scene.layers.sections) {
      const count = left.length - 1;
      for (let k = 0; k <= 40; k += 1) {
        const i = Math.round((k / 40) * count);
        this.line([left[i], right[i]], this.colour("section"), 0.7);
      }
    }
    this.line(centre, this.colour("section"), 0.9, [7, 3]);
    const dash = asked ? [] : [3, 3];
    this.outline(outline, asked ? this.colour("outline") : this.colour("bad"), 1.4, dash);
    // The support.
    const [base, top, bottom] = [this.at(centre[0]), this.at(left[0]), this.at(right[0])];
    const reach = 1.5;
    this.support([base[0] + reach * (top[0] - base[0]), base[1] + reach * (top[1] - base[1])],
      [base[0] + reach * (bottom[0] - base[0]), base[1] + reach * (bottom[1] - base[1])]);
    cables.forEach((line, c) => this.cable(line, c, shape, [], left.length - 1));
  }

  /**
   * A wall with hatching, from one end to the other; the arm leaves it to its left.
   * @param {Point} from
   * @param {Point} to
   */
  support([x0, y0], [x1, y1]) {
    const { ctx } = this;
    const length = Math.hypot(x1 - x0, y1 - y0) || 1;
    const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
    ctx.strokeStyle = this.colour("outline");
    ctx.lineWidth = 1.6;
    ctx.beginPath();
    ctx.moveTo(x0, y0);
    ctx.lineTo(x1, y1);
    ctx.stroke();
    ctx.lineWidth = 0.8;
    ctx.beginPath();
    for (let d = 3; d < length; d += 6) {
      ctx.moveTo(x0 + d * ux, y0 + d * uy);
      ctx.lineTo(x0 + (d + 5) * ux - 6 * uy, y0 + (d + 5) * uy + 6 * ux);
    }
    ctx.stroke();
  }

  /**
   * The body in colours: the more of the quantity, the darker.
   * @param {Solution} shape
   * @param {Outline} outline
   */
  tinted(shape, { left, right }) {
    const { ctx } = this;
    const tint = this.tint(shape);
    for (let i = 0; tint && i + 1 < left.length; i += 1) {
      ctx.fillStyle = tint(i);
      this.trace([left[i], left[i + 1], right[i + 1], right[i]]);
      ctx.fill();
    }
  }

  /** The colour of the body between a station and the next; none where it is plain. @param {Solution} shape */
  tint({ stations: st }) {
    const { tints } = this.scene;
    if (tints === "plain") return undefined;
    const shear = st.eta.map((eta, i) => Math.hypot(eta, st.zeta?.[i] ?? 0));
    const values = { nu: st.nu.map((nu) => nu - 1), eta: shear, alpha: st.alpha }[tints];
    const most = Math.max(...values.map(Math.abs), 1e-12);
    return (/** @type {number} */ i) => this.shade(Math.abs(0.5 * (values[i] + (values[i + 1] ?? values[i]))) / most);
  }

  /**
   * The contact force along the arm: what the part towards the tip exerts on the section.
   * @param {Shown} shown
   */
  contact({ shape, outline }) {
    const st = shape.stations;
    if (st.n_a.length === 0) return;
    const most = Math.max(...st.n_a.map((_, i) => Math.hypot(...contactOf(shape, i))), 1e-300);
    const count = st.s.length - 1;
    for (let k = 0; k <= 14; k += 1) {
      const i = Math.round((k / 14) * count);
      this.contactAt(shape, outline, i, 58 / most);
    }
  }

  /**
   * @param {Solution} shape
   * @param {Outline} outline
   * @param {number} i
   * @param {number} scale pixels a newton
   */
  contactAt(shape, outline, i, scale) {
    const [fx, fy] = flat(this.view.camera, contactOf(shape, i));
    const [x, y] = this.at(outline.centre[i]);
    this.arrow([x, y], [x + scale * fx, y - scale * fy], this.colour("series-3"), 1.5);
  }

  /**
   * Directors a, b and tangent t at the tip, with the angle from a to t.
   * @param {Shown} shown
   */
  directors({ shape, outline }) {
    const { ctx } = this;
    const { theta, alpha } = shape.tip;
    if (theta === undefined) {
      this.directorsInSpace(shape, outline);
      return;
    }
    const tip = this.at(outline.centre[outline.centre.length - 1]);
    const end = (/** @type {number} */ angle, /** @type {number} */ length) =>
      /** @type {Point} */ ([tip[0] + length * Math.cos(angle), tip[1] - length * Math.sin(angle)]);
    const ink = this.colour("ink");
    const green = this.colour("series-2");
    /** @type {[string, number, string][]} */
    const arrows = [["a", theta, ink], ["b", theta + Math.PI / 2, ink]];
    if (Math.abs(alpha) > 0.02) arrows.push(["t", theta + alpha, green]);
    for (const [name, angle, colour] of arrows) {
      this.arrow(tip, end(angle, 42), colour, 1.4);
      this.text(name, end(angle, 53), colour, "center", "italic ");
    }
    if (Math.abs(alpha) > 0.02) {
      ctx.strokeStyle = green;
      ctx.lineWidth = 1.2;
      ctx.beginPath();
      ctx.arc(tip[0], tip[1], 25, -theta, -(theta + alpha), alpha > 0);
      ctx.stroke();
    }
    const label = `\u03b1(L) = ${fixed(degrees(alpha), 2)}\u00b0`;
    const away = end(theta - (Math.PI * 3) / 4, 58);
    this.text(label, away, ink, Math.cos(theta - (Math.PI * 3) / 4) < 0 ? "right" : "left");
  }

  /** @param {Solution} shape @param {Outline} outline */
  directorsInSpace(shape, outline) {
    const tip = this.at(outline.centre[outline.centre.length - 1]);
    const ink = this.colour("ink");
    const { alpha } = shape.tip;
    for (const name of /** @type {const} */ (["a", "b", "c"])) {
      const direction = shape.tip[name];
      if (direction) this.text(name, this.named(this.along(tip, direction, 42, ink, 1.4), tip), ink, "center", "italic ");
    }
    if (Math.abs(alpha) > 0.02) {
      const green = this.colour("series-2");
      const end = this.along(tip, tangent(shape, shape.stations.s.length - 1), 42, green, 1.4);
      this.text("t", this.named(end, tip), green, "center", "italic ");
    }
    this.text(`\u03b1(L) = ${fixed(degrees(alpha), 2)}\u00b0`, [tip[0] + 16, tip[1] + 64], ink, "left");
  }

  /** A little further than an end, seen from a place. @param {Point} end @param {Point} from @returns {Point} */
  named([x, y], [x0, y0]) {
    const length = Math.hypot(x - x0, y - y0) || 1;
    return [x + (10 * (x - x0)) / length, y + (10 * (y - y0)) / length];
  }

  /** The directions e1, e2 and e3 in a corner. */
  axes() {
    const quiet = this.colour("quiet");
    /** @type {Point} */
    const corner = [44, this.view.height - 44];
    const all = /** @type {[string, Place][]} */ ([["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]]);
    for (const [name, direction] of all) this.text(name, this.named(this.along(corner, direction, 24, quiet, 1.3), corner), quiet, "center", "italic ");
  }

  /**
   * Text that stays readable on whatever is below it.
   * @param {string} text
   * @param {Point} place
   * @param {string} colour
   * @param {CanvasTextAlign} align
   * @param {string} [style]
   */
  text(text, [x, y], colour, align, style = "") {
    const { ctx, view } = this;
    ctx.font = style + FONT;
    ctx.textAlign = align;
    ctx.textBaseline = "middle";
    const width = ctx.measureText(text).width;
    const least = align === "right" ? width + 6 : align === "center" ? 0.5 * width + 6 : 6;
    const most = view.width - (align === "left" ? width + 6 : align === "center" ? 0.5 * width + 6 : 6);
    const [px, py] = [Math.max(least, Math.min(most, x)), Math.max(10, Math.min(view.height - 10, y))];
    ctx.strokeStyle = this.colour("water");
    ctx.lineWidth = 4;
    ctx.strokeText(text, px, py);
    ctx.fillStyle = colour;
    ctx.fillText(text, px, py);
  }

  trail() {
    const { ctx, scene } = this;
    const { trail } = scene;
    const colour = this.colour("accent");
    for (let i = 1; i < trail.length; i += 1) {
      ctx.globalAlpha = 0.08 + (0.6 * i) / trail.length;
      this.line([trail[i - 1], trail[i]].map((place) => flat(this.view.camera, place)), colour, 2);
    }
    ctx.globalAlpha = 1;
  }

  /** The tip's way along a path: dotted where shapes are unstable, with its events. */
  way() {
    const { ctx, scene } = this;
    const ink = this.colour("series-1");
    for (let i = 1; i < scene.way.length; i += 1) {
      const [a, b] = [scene.way[i - 1], scene.way[i]];
      this.line([a.place, b.place].map((place) => flat(this.view.camera, place)), ink, 1.4, a.stable && b.stable ? [] : [2, 4]);
    }
    for (const { place, event } of scene.way) {
      if (event === null) continue;
      ctx.fillStyle = this.colour("series-0");
      ctx.beginPath();
      ctx.arc(...this.seen(place), 5, 0, 2 * Math.PI);
      ctx.fill();
      const [x, y] = this.seen(place);
      this.text(event.replaceAll("_", " "), [x + 9, y - 9], this.colour("series-0"), "left");
    }
  }

  /**
   * A station: its section against the normal of the centreline, its contact force, and its numbers.
   * @param {Shown} shown
   * @param {number} i
   */
  hovered({ shape, outline }, i) {
    const st = shape.stations;
    if (i >= st.s.length) return;
    const centre = this.at(outline.centre[i]);
    if (outline.space) this.line(outline.space.ring(i), this.colour("accent"), 2.2);
    else this.sectionAt(shape, outline, i);
    // Of a moving arm no forces are known.
    const size = st.n_a.length > 0 ? Math.hypot(...contactOf(shape, i)) : NaN;
    if (size > 0) this.contactAt(shape, outline, i, 60 / size);
    const lines = [
      `s = ${fixed(1e3 * st.s[i], 1)} mm`,
      `\u03b1 = ${fixed(degrees(st.alpha[i]), 2)}\u00b0   \u03b7 = ${fixed(st.eta[i], 4)}   \u03bd = ${fixed(st.nu[i], 4)}`,
      ...(size >= 0 ? [`contact ${force(size)}   moment ${fixed(1e3 * momentAt(shape, i), 3)} N mm`] : []),
    ];
    if (st.tau && st.kappa) lines.splice(2, 0, `\u03c4 = ${fixed(st.tau[i], 2)}   \u03ba = ${fixed(st.kappa[i], 2)}   \u03bc = ${fixed(st.mu[i], 2)} 1/m`);
    const right = centre[0] < 0.6 * this.view.width;
    lines.forEach((line, k) => {
      this.text(line, [centre[0] + (right ? 26 : -26), centre[1] - 34 + 16 * k], this.colour("ink"), right ? "left" : "right");
    });
  }

  /** A section of the plane against the normal of the centreline. @param {Solution} shape @param {Outline} outline @param {number} i */
  sectionAt({ stations: st }, outline, i) {
    const { ctx } = this;
    const phi = (st.theta?.[i] ?? 0) + st.alpha[i];
    const centre = this.at(outline.centre[i]);
    const half = 0.5 * Math.hypot(outline.left[i][0] - outline.right[i][0], outline.left[i][1] - outline.right[i][1]);
    const reach = Math.max(this.view.k * half, 14);
    const [nx, ny] = [-reach * Math.sin(phi), -reach * Math.cos(phi)];
    ctx.setLineDash([3, 3]);
    ctx.strokeStyle = this.colour("series-2");
    ctx.lineWidth = 1.4;
    ctx.beginPath();
    ctx.moveTo(centre[0] + nx, centre[1] + ny);
    ctx.lineTo(centre[0] - nx, centre[1] - ny);
    ctx.stroke();
    ctx.setLineDash([]);
    this.line([outline.left[i], outline.right[i]], this.colour("accent"), 2.6);
  }

  /** @param {Place} target */
  target(target) {
    const { ctx, scene } = this;
    const [x, y] = this.seen(target);
    ctx.strokeStyle = this.colour("bad");
    ctx.lineWidth = 2;
    ctx.beginPath();
    for (const [dx, dy] of [[6, 6], [6, -6]]) {
      ctx.moveTo(x - dx, y - dy);
      ctx.lineTo(x + dx, y + dy);
    }
    ctx.stroke();
    const centre = scene.shown?.outline.centre;
    if (centre) this.line([centre[centre.length - 1], flat(this.view.camera, target)], this.colour("bad"), 1, [2, 3]);
  }

  /** A bar of a round length. */
  scale() {
    const { ctx, view } = this;
    const most = 130 / view.k;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = ([5, 2, 1].find((step) => step * power <= most) ?? 1) * power;
    const [x1, y] = [view.width - 18, view.height - 18];
    const x0 = x1 - view.k * length;
    ctx.strokeStyle = this.colour("quiet");
    ctx.lineWidth = 1.2;
    ctx.beginPath();
    ctx.moveTo(x0, y - 4);
    ctx.lineTo(x0, y);
    ctx.lineTo(x1, y);
    ctx.lineTo(x1, y - 4);
    ctx.stroke();
    const text = length >= 1 ? `${length} m` : length >= 1e-3 ? `${Number((1e3 * length).toPrecision(2))} mm` : `${Number((1e6 * length).toPrecision(2))} \u00b5m`;
    this.text(text, [0.5 * (x0 + x1), y - 12], this.colour("quiet"), "center");
  }

  /** The direction of gravity, in a corner that is not its own. @param {Solution} shape */
  gravity(shape) {
    const { gravity } = shape.inputs;
    if (!gravity || !(gravity.acceleration > 0)) return;
    const [x, y] = [CORNER, CORNER];
    this.along([x, y], directionOf(gravity.direction), 34, this.colour("quiet"), 1.8, 0.5);
    this.text("gravity", [x + 24, y], this.colour("quiet"), "left");
  }

  /** Where the arm passes through itself. @param {Point} place */
  crossing(place) {
    const { ctx } = this;
    ctx.strokeStyle = this.colour("bad");
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.arc(...this.at(place), 11, 0, 2 * Math.PI);
    ctx.stroke();
  }

  /** The colour of a share from 0 to 1. @param {number} share */
  shade(share) {
    const place = Math.min(Math.max(share, 0), 1) * (SHADES - 1);
    const at = Math.min(Math.floor(place), SHADES - 2);
    const [low, high] = [at, at + 1].map((k) => bytes(this.colour(`shade-${k}`)));
    return `rgb(${low.map((v, c) => Math.round(v + (place - at) * (high[c] - v))).join(" ")})`;
  }
}

/** The contact force at a station in space, N. @param {Solution} shape @param {number} i @returns {Place} */
function contactOf({ stations: st }, i) {
  if (st.theta) {
    const [cos, sin] = [Math.cos(st.theta[i]), Math.sin(st.theta[i])];
    return [st.n_a[i] * cos - st.n_b[i] * sin, st.n_a[i] * sin + st.n_b[i] * cos, 0];
  }
  const parts = /** @type {[number, Place | undefined][]} */ ([[st.n_a[i], st.a?.[i]], [st.n_b[i], st.b?.[i]], [st.n_c?.[i] ?? 0, st.c?.[i]]]);
  const sum = (/** @type {number} */ k) => parts.reduce((all, [n, director]) => all + n * (director?.[k] ?? 0), 0);
  return [sum(0), sum(1), sum(2)];
}

/** The contact moment at a station, in space its size, N m. @param {Solution} shape @param {number} i */
function momentAt({ stations: st }, i) {
  return st.m ? st.m[i] : Math.hypot(st.m_a?.[i] ?? 0, st.m_b?.[i] ?? 0, st.m_c?.[i] ?? 0);
}

/** A colour in more or less light. @param {string} colour #rrggbb or rgb(r g b) @param {number} light from 0 to 1 */
function lit(colour, light) {
  const parts = colour.startsWith("#") ? bytes(colour) : (colour.match(/[\d.]+/g) ?? []).slice(0, 3).map(Number);
  const share = 0.58 + 0.5 * light;
  return `rgb(${parts.map((v) => Math.round(Math.min(255, share * v))).join(" ")})`;
}

/** Red, green and blue of #rrggbb. @param {string} hex */
const bytes = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
