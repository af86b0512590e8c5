import { h } from "./dom";
import type { Picture } from "./report";

function source(picture: Picture): string {
  return `data:${picture.mime};base64,${picture.base64}`;
}

function altText(picture: Picture, rowTitle: string): string {
  return [rowTitle, picture.title, picture.caption].filter((text) => text !== "").join(", ");
}

/** Shows one picture large; the arrow keys flip through its row in place, so that differences stand out. */
function openLarge(pictures: Picture[], rowTitle: string, start: number): void {
  let at = start;
  const image = h("img");
  const caption = h("p", { role: "status" });
  const close = h("button", { type: "button" }, "Close");
  const previous = h("button", { type: "button", "aria-label": "Previous picture" }, "←");
  const next = h("button", { type: "button", "aria-label": "Next picture" }, "→");
  const dialog = h(
    "dialog",
    { class: "large", "aria-label": rowTitle || "Picture" },
    image,
    h("div", { class: "large-bar" }, previous, next, caption, close),
  );
  const show = (index: number): void => {
    at = (index + pictures.length) % pictures.length;
    const picture = pictures[at];
    if (!picture) return;
    image.src = source(picture);
    image.alt = altText(picture, rowTitle);
    caption.textContent = `${at + 1} of ${pictures.length}: ${[picture.title, picture.caption].filter(Boolean).join(", ")}`;
  };
  previous.addEventListener("click", () => show(at - 1));
  next.addEventListener("click", () => show(at + 1));
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("keydown", (event) => {
    if (event.key === "ArrowLeft") show(at - 1);
    if (event.key === "ArrowRight") show(at + 1);
  });
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  dialog.addEventListener("close", () => dialog.remove());
  show(start);
  document.body.append(dialog);
  dialog.showModal();
}

export function renderPictureRow(title: string, pictures: Picture[]): HTMLElement {
  const figure = (picture: Picture, index: number): HTMLElement => {
    const image = h("img", { src: source(picture), alt: altText(picture, title), decoding: "async" });
    const open = h(
      "button",
      { type: "button", class: "picture", "aria-label": `Enlarge: ${altText(picture, title)}` },
      image,
    );
    open.addEventListener("click", () => openLarge(pictures, title, index));
    return h(
      "figure",
      {},
      open,
      h(
        "figcaption",
        {},
        h("b", {}, picture.title),
        picture.caption !== "" && h("span", { class: "muted block" }, picture.caption),
      ),
    );
  };
  return h(
    "div",
    { class: "picture-row" },
    title !== "" && h("h4", {}, title),
    h("div", { class: "pictures" }, pictures.map(figure)),
  );
}
