// Elements made in one line.

type Props = Record<string, unknown>;
type Child = Node | string | null | undefined | false;

function fill<T extends Element>(element: T, props: Props, children: Child[]): T {
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value as EventListener);
    else if (name === "value" || name === "checked") (element as any)[name] = value;
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
  return element;
}

export const h = <K extends keyof HTMLElementTagNameMap>(tag: K, props: Props = {}, ...children: Child[]) =>
  fill(document.createElement(tag), props, children);

export const s = (tag: string, props: Props = {}, ...children: Child[]) =>
  fill(document.createElementNS("http://www.w3.org/2000/svg", tag) as SVGElement, props, children);

export const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** A number for people: four digits that count. */
export const short = (x: number) =>
  !Number.isFinite(x) ? "–" : x === 0 ? "0" : Math.abs(x) < 1e-4 ? x.toExponential(1) : String(+x.toPrecision(4));

export const plural = (n: number, one: string, many: string) => `${n} ${n === 1 ? one : many}`;
