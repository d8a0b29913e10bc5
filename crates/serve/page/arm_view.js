// The drawing: pan, zoom, turn, hover, and the tip that can be pulled.

/** @import { Place, Point, Shown } from "./types" */
/** @import { Camera } from "./camera.js" */
/** @import { Scene, View } from "./paint.js" */

import { FRONT, SIDES, flat, placeAt, turned } from "./camera.js";
import { boundsOf, nearest } from "./geometry.js";
import { byId, kept } from "./page.js";
import { Painter, colours } from "./paint.js";

/** Most points of the tip's trail. */
const TRAIL = 400;

export class ArmView {
  /**
   * @param {(target: Place, asked: number) => void} onPull
   * @param {() => void} onRelease
   * @param {(s: number | undefined) => void} onHover
   */
  constructor(onPull, onRelease, onHover) {
    this.canvas = byId("drawing", HTMLCanvasElement);
    this.handle = byId("tip", HTMLButtonElement);
    /** Views to choose, of an arm in space. */
    this.sides = byId("sides", HTMLElement);
    /** What to do first, until it was done once. */
    this.hint = byId("hint", HTMLElement);
    this.isNew = kept.get("tip") === null;
    const ctx = this.canvas.getContext("2d");
    if (!ctx) throw new Error("the browser has no canvas");
    this.ctx = ctx;
    this.onPull = onPull;
    this.onRelease = onRelease;
    this.onHover = onHover;
    /** @type {Scene} */
    this.scene = {
      shown: undefined, ghost: undefined, pins: [], extra: undefined, trail: [], way: [], target: undefined, hover: undefined,
      tints: "plain",
      layers: { sections: true, stream: true, gravity: true, layer: true, ghost: true, trail: true, directors: true, contact: false },
    };
    /** @type {View} */
    this.view = { k: 1000, ox: 0, oy: 0, width: 1, height: 1, camera: FRONT };
    this.fitted = true;
    this.colour = colours();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.listen();
    this.resize();
  }

  /** Takes the size of the page's place for it, in the pixels of the screen. */
  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(1, Math.round(width * ratio));
    this.canvas.height = Math.max(1, Math.round(height * ratio));
    this.ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    const moved = [0.5 * (width - this.view.width), 0.5 * (height - this.view.height)];
    this.view = { ...this.view, width, height, ox: this.view.ox + moved[0], oy: this.view.oy + moved[1] };
    if (this.fitted) this.fit();
    else this.paint();
  }

  /** The theme has changed. */
  recolour() {
    this.colour = colours();
    this.paint();
  }

  /** @param {Omit<Shown, "outline">} answer */
  show(answer) {
    const first = this.scene.shown === undefined;
    if (first) this.look(answer.shape.stations.z ? SIDES["3D"] : FRONT);
    const shown = { ...answer, outline: answer.body(this.view.camera) };
    this.scene.shown = shown;
    const tip = shown.outline.centre[shown.outline.centre.length - 1];
    const place = shown.outline.tip;
    const last = this.scene.trail[this.scene.trail.length - 1];
    if (shown.asked && (!last || Math.hypot(last[0] - place[0], last[1] - place[1], last[2] - place[2]) * this.view.k > 0.5)) {
      this.scene.trail.push(place);
      if (this.scene.trail.length > TRAIL) this.scene.trail.shift();
    }
    if (first || (this.fitted && !this.scene.target && this.isOut(tip))) this.fit();
    else this.paint();
  }

  /** Sees everything from elsewhere. @param {Camera} camera */
  look(camera) {
    this.view.camera = camera;
    const { shown } = this.scene;
    if (shown) shown.outline = shown.body(camera);
    const chosen = Object.keys(SIDES).find((name) => SIDES[name] === camera);
    for (const button of this.sides.querySelectorAll("button")) button.setAttribute("aria-pressed", String(button.dataset.side === chosen));
  }

  /** Turns what is seen about the middle of the picture, px as the hand moves. @param {number} dx @param {number} dy */
  turn(dx, dy) {
    const { camera } = this.view;
    const { shown } = this.scene;
    // The middle of the arm stays where it is.
    const middle = shown ? placeAt(camera, shown.outline.centre[shown.outline.centre.length >> 1], shown.outline.tip) : FRONT.back;
    const before = this.toPage(flat(camera, middle));
    this.look(turned(camera, 0.008 * dx, 0.008 * dy));
    const after = this.toPage(flat(this.view.camera, middle));
    if (this.fitted) this.fit();
    else this.pan(before[0] - after[0], before[1] - after[1]);
  }

  /** Whether what is shown is in space. */
  get inSpace() {
    return this.scene.shown?.outline.space !== undefined;
  }

  /** Whether a place is off the page or at its edge. @param {Point} point */
  isOut(point) {
    const [x, y] = this.toPage(point);
    return x < 20 || y < 20 || x > this.view.width - 20 || y > this.view.height - 20;
  }

  /** Forgets what belongs to the arm before. */
  clear() {
    Object.assign(this.scene, { shown: undefined, trail: [], way: [], extra: undefined, target: undefined, hover: undefined });
    this.fitted = true;
  }

  /** Shows all of the arm. */
  fit() {
    const { shown, ghost } = this.scene;
    const { camera } = this.view;
    const lines = [shown?.outline, ghost?.(camera)].flatMap((o) => (o ? [o.left, o.right] : []));
    lines.push(this.scene.way.map(({ place }) => flat(camera, place)));
    this.fitted = true;
    if (shown) {
      const { x, y } = boundsOf(lines);
      const { width, height } = this.view;
      const [w, h] = [Math.max(x[1] - x[0], 1e-9), Math.max(y[1] - y[0], 1e-9)];
      // Room for the directors at the tip, for gravity above and the scale below.
      const [top, bottom] = [62, 52];
      const k = Math.min((width - Math.min(150, 0.3 * width)) / w, (height - top - bottom) / h);
      this.view.k = Math.max(k, 1e-3);
      this.view.ox = 0.5 * width - 0.5 * this.view.k * (x[0] + x[1]);
      this.view.oy = 0.5 * (height + top - bottom) + 0.5 * this.view.k * (y[0] + y[1]);
    }
    this.paint();
  }

  /**
   * The picture with a line of words below it, to take away.
   * @param {string} words
   */
  image(words) {
    const { canvas, colour } = this;
    const ratio = canvas.width / Math.max(this.view.width, 1);
    const below = 30 * ratio;
    const image = document.createElement("canvas");
    [image.width, image.height] = [canvas.width, canvas.height + below];
    const ctx = image.getContext("2d");
    if (!ctx) return canvas;
    ctx.fillStyle = colour("card");
    ctx.fillRect(0, 0, image.width, image.height);
    ctx.drawImage(canvas, 0, 0);
    ctx.fillStyle = colour("ink");
    ctx.font = `${13 * ratio}px system-ui, "Noto Sans", sans-serif`;
    ctx.textBaseline = "middle";
    ctx.fillText(words, 12 * ratio, canvas.height + 0.5 * below, image.width - 24 * ratio);
    return image;
  }

  paint() {
    new Painter(this.ctx, this.view, this.scene, this.colour).paint();
    const centre = this.scene.shown?.outline.centre;
    this.sides.hidden = !this.inSpace;
    this.handle.hidden = !centre || !this.scene.shown?.asked;
    if (centre) {
      const [x, y] = this.toPage(centre[centre.length - 1]);
      this.handle.style.transform = `translate(${x}px, ${y}px)`;
      this.hint.hidden = !this.isNew || this.handle.hidden;
      if (!this.hint.hidden) this.placeHint([x, y]);
    }
  }

  /** Beside the tip, between the director a and the label of the angle, and inside of the picture. @param {Point} tip */
  placeHint([x, y]) {
    const { offsetWidth: width, offsetHeight: height } = this.hint;
    const angle = (this.scene.shown?.shape.tip.theta ?? this.tipAngle()) - Math.PI / 4;
    const middle = [x + (0.5 * width + 18) * Math.cos(angle), y - (0.5 * height + 20) * Math.sin(angle)];
    const inside = (/** @type {number} */ v, /** @type {number} */ size, /** @type {number} */ most) => Math.min(Math.max(v - 0.5 * size, 4), most - size - 4);
    this.hint.style.transform = `translate(${inside(middle[0], width, this.view.width)}px, ${inside(middle[1], height, this.view.height)}px)`;
  }

  /** The direction of the centreline at the tip as it is seen, rad. */
  tipAngle() {
    const [[x0, y0], [x1, y1]] = (this.scene.shown?.outline.centre ?? [[0, 0], [1, 0]]).slice(-2);
    return Math.atan2(y1 - y0, x1 - x0);
  }

  /** @param {Point} point @returns {Point} */
  toPage([x, y]) {
    return [this.view.ox + this.view.k * x, this.view.oy - this.view.k * y];
  }

  /** @param {Point} point @returns {Point} */
  toArm([x, y]) {
    return [(x - this.view.ox) / this.view.k, (this.view.oy - y) / this.view.k];
  }

  /**
   * @param {PointerEvent | WheelEvent} event
   * @returns {Point}
   */
  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /**
   * @param {number} factor
   * @param {Point} [about] the place on the page that stays
   */
  zoom(factor, about = [0.5 * this.view.width, 0.5 * this.view.height]) {
    const k = Math.min(Math.max(this.view.k * factor, 20), 2e6);
    const [x, y] = this.toArm(about);
    Object.assign(this.view, { k, ox: about[0] - k * x, oy: about[1] + k * y });
    this.fitted = false;
    this.paint();
  }

  /** @param {number} dx @param {number} dy */
  pan(dx, dy) {
    this.view.ox += dx;
    this.view.oy += dy;
    this.fitted = false;
    this.paint();
  }

  /** @param {number | undefined} index */
  hover(index) {
    if (this.scene.hover === index) return;
    this.scene.hover = index;
    this.paint();
  }

  listen() {
    byId("zoom-in", HTMLButtonElement).addEventListener("click", () => this.zoom(1.3));
    byId("zoom-out", HTMLButtonElement).addEventListener("click", () => this.zoom(1 / 1.3));
    byId("fit", HTMLButtonElement).addEventListener("click", () => this.fit());
    for (const button of this.sides.querySelectorAll("button")) {
      button.addEventListener("click", () => {
        this.look(SIDES[button.dataset.side ?? "3D"]);
        this.fit();
      });
    }
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-0.0015 * event.deltaY), this.placeOf(event));
    }, { passive: false });
    this.canvas.addEventListener("keydown", (event) => {
      // In space arrows turn, and move the view with Shift.
      const turns = this.inSpace && !event.shiftKey;
      const step = event.shiftKey && !this.inSpace ? 100 : 25;
      const go = (/** @type {number} */ dx, /** @type {number} */ dy) => (turns ? this.turn(-0.5 * dx, -0.5 * dy) : this.pan(dx, dy));
      /** @type {Record<string, () => void>} */
      const keys = {
        ArrowLeft: () => go(step, 0), ArrowRight: () => go(-step, 0), ArrowUp: () => go(0, step),
        ArrowDown: () => go(0, -step), "+": () => this.zoom(1.3), "=": () => this.zoom(1.3), "-": () => this.zoom(1 / 1.3),
        0: () => this.fit(),
      };
      if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      keys[event.key]();
    });
    this.listenToFingers();
    this.listenToTip();
  }

  /** One pointer pans, or turns what is in space; two pan and zoom, as one does with Shift or another button. */
  listenToFingers() {
    /** @type {Map<number, Point>} */
    const down = new Map();
    let moves = false;
    this.canvas.addEventListener("contextmenu", (event) => this.inSpace && event.preventDefault());
    this.canvas.addEventListener("pointerdown", (event) => {
      down.set(event.pointerId, this.placeOf(event));
      moves = event.shiftKey || event.button !== 0;
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const before = down.get(event.pointerId);
      const now = this.placeOf(event);
      if (!before) {
        this.pointAt(now);
        return;
      }
      const others = [...down].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      down.set(event.pointerId, now);
      if (others.length === 0) {
        if (this.inSpace && !moves) this.turn(now[0] - before[0], now[1] - before[1]);
        else this.pan(now[0] - before[0], now[1] - before[1]);
      } else {
        if (this.inSpace) this.pan(0.5 * (now[0] - before[0]), 0.5 * (now[1] - before[1]));
        const other = others[0];
        const [was, is] = [before, now].map(([x, y]) => Math.hypot(x - other[0], y - other[1]));
        this.zoom(is / Math.max(was, 1), other);
      }
    });
    for (const kind of ["pointerup", "pointercancel"]) {
      this.canvas.addEventListener(kind, (event) => down.delete(/** @type {PointerEvent} */ (event).pointerId));
    }
    this.canvas.addEventListener("pointerleave", () => this.onHover(undefined));
  }

  /** @param {Point} place on the page */
  pointAt(place) {
    const shown = this.scene.shown;
    if (!shown) return;
    const { index, distance } = nearest(shown.outline.centre, this.toArm(place));
    this.onHover(distance * this.view.k < 40 ? shown.shape.stations.s[index] : undefined);
  }

  listenToTip() {
    const { handle } = this;
    /** From the pointer to the tip, on the page. @type {Point | undefined} */
    let grip;
    /** Where it was taken hold of: it stays as near as that. @type {Place} */
    let held = [0, 0, 0];
    handle.addEventListener("pointerdown", (event) => {
      const centre = this.scene.shown?.outline.centre;
      if (!centre) return;
      const [x, y] = this.placeOf(event);
      const tip = this.toPage(centre[centre.length - 1]);
      grip = [tip[0] - x, tip[1] - y];
      held = this.scene.shown?.outline.tip ?? held;
      handle.setPointerCapture(event.pointerId);
      event.preventDefault();
      handle.focus();
    });
    handle.addEventListener("pointermove", (event) => {
      if (!grip) return;
      const [x, y] = this.placeOf(event);
      this.pull(placeAt(this.view.camera, this.toArm([x + grip[0], y + grip[1]]), held), event.timeStamp);
    });
    for (const kind of ["pointerup", "pointercancel"]) {
      handle.addEventListener(kind, () => {
        if (grip) this.release();
        grip = undefined;
      });
    }
    handle.addEventListener("keydown", (event) => {
      /** @type {Record<string, Point>} */
      const keys = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
      const { shown } = this.scene;
      if (!keys[event.key] || !shown) return;
      event.preventDefault();
      const step = (event.shiftKey ? 0.05 : 0.01) * shown.shape.inputs.arm.length;
      const from = this.scene.target ?? shown.outline.tip;
      const [x, y] = flat(this.view.camera, from);
      this.pull(placeAt(this.view.camera, [x + step * keys[event.key][0], y + step * keys[event.key][1]], from), event.timeStamp);
    });
    handle.addEventListener("keyup", () => this.scene.target && this.release());
    handle.addEventListener("blur", () => this.scene.target && this.release());
  }

  /** @param {Place} target @param {number} asked */
  pull(target, asked) {
    this.scene.target = target;
    if (this.isNew) {
      this.isNew = false;
      kept.set("tip", "pulled");
    }
    handleHeld(this.handle, true);
    this.onPull(target, asked);
  }

  release() {
    this.scene.target = undefined;
    handleHeld(this.handle, false);
    this.onRelease();
    this.paint();
  }
}

/** @param {HTMLElement} handle @param {boolean} held */
function handleHeld(handle, held) {
  handle.dataset.held = String(held);
}
