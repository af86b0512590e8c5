// Elements without a framework. Text is always set as text, never as markup.

type Child = Node | string | null | false | Child[];
type Attributes = Record<string, string | number | boolean | undefined>;

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
  append(element, children);
  return element;
}

function append(element: HTMLElement, children: Child[]): void {
  for (const child of children) {
    if (child === null || child === false) continue;
    if (Array.isArray(child)) append(element, child);
    else element.append(child);
  }
}

/** The head of a table; kind gives the class of a column. */
export function tableHead(names: string[], kind: (column: number) => string = () => ""): HTMLElement {
  const cells = names.map((name, i) =>
    h("th", { scope: "col", role: "columnheader", class: kind(i) || undefined }, name),
  );
  return h("thead", { role: "rowgroup" }, h("tr", { role: "row" }, cells));
}

/** A box that scrolls sideways by itself; focusable, so that the arrow keys reach it. */
export function scrollBox(label: string, child: HTMLElement): HTMLElement {
  return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label }, child);
}

/** An id that is safe as a fragment whatever the text is. */
export function anchor(kind: string, index: number): string {
  return `${kind}-${index + 1}`;
}
