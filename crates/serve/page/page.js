// Small helpers for the page's elements.

/**
 * The element with this id.
 * @template {typeof HTMLElement} T
 * @param {string} id
 * @param {T} kind
 * @returns {InstanceType<T>}
 */
export function byId(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${kind.name} with the id ${id}`);
  return /** @type {InstanceType<T>} */ (found);
}

/**
 * A new element.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, string | boolean | undefined>} [attributes] `text` is its text
 * @param {(Node | string)[]} [children]
 * @returns {HTMLElementTagNameMap[K]}
 */
export function element(tag, attributes = {}, children = []) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    if (name === "text") made.textContent = String(value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children);
  return made;
}

/** @type {ReturnType<typeof setTimeout> | undefined} */
let fading;

/**
 * Says something in passing.
 * @param {string} text
 * @param {"good" | "bad"} [level]
 */
export function toast(text, level = "good") {
  const box = byId("toast", HTMLElement);
  box.textContent = text;
  box.classList.toggle("bad", level === "bad");
  box.classList.add("on");
  clearTimeout(fading);
  fading = setTimeout(() => box.classList.remove("on"), level === "bad" ? 7000 : 2500);
}

/**
 * Calls `work` once things have been quiet for `delay` ms.
 * @param {number} delay
 * @param {() => void} work
 */
export function settled(delay, work) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(work, delay);
  };
}

/**
 * Closes menus that were left open, and lets Escape close them.
 */
export function tidyMenus() {
  document.addEventListener("click", (event) => {
    for (const menu of document.querySelectorAll("details.menu[open]")) {
      if (event.target instanceof Node && !menu.contains(event.target)) menu.removeAttribute("open");
    }
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    for (const menu of document.querySelectorAll("details.menu[open]")) {
      menu.removeAttribute("open");
      menu.querySelector("summary")?.focus();
    }
  });
}

/** What is kept from visit to visit; nothing where the browser keeps nothing. */
export const kept = {
  /** @param {string} name @returns {string | null} */
  get(name) {
    try {
      return localStorage.getItem(name);
    } catch {
      return null;
    }
  },
  /** @param {string} name @param {string} value */
  set(name, value) {
    try {
      localStorage.setItem(name, value);
    } catch {
      // It holds until the page is left.
    }
  },
};
