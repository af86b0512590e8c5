import { h } from "./dom";

/** One bubble for the whole page: a child of the body, so that no scrolling box cuts it off. */
export function installTooltips(): void {
  const bubble = h("div", { class: "tooltip", role: "tooltip", id: "tooltip", hidden: true });
  document.body.append(bubble);
  let shown: HTMLElement | null = null;

  const hide = (): void => {
    shown?.removeAttribute("aria-describedby");
    shown = null;
    bubble.hidden = true;
  };
  const place = (target: HTMLElement): void => {
    const at = target.getBoundingClientRect();
    const size = bubble.getBoundingClientRect();
    const margin = 8;
    const left = Math.min(at.left, document.documentElement.clientWidth - size.width - margin);
    const below = at.bottom + margin;
    const top = below + size.height < window.innerHeight ? below : at.top - size.height - margin;
    bubble.style.left = `${Math.max(margin, left)}px`;
    bubble.style.top = `${Math.max(margin, top)}px`;
  };
  const show = (event: Event): void => {
    const target = event.target instanceof Element ? event.target.closest<HTMLElement>("[data-tip]") : null;
    if (target === shown) return;
    hide();
    if (!target) return;
    shown = target;
    bubble.textContent = target.dataset["tip"] ?? "";
    bubble.hidden = false;
    target.setAttribute("aria-describedby", "tooltip");
    place(target);
  };
  // What the keyboard reaches scrolls into view by itself: its bubble goes along.
  const follow = (): void => {
    if (shown && shown === document.activeElement) place(shown);
    else hide();
  };
  document.addEventListener("pointerover", show);
  document.addEventListener("focusin", show);
  document.addEventListener("focusout", hide);
  document.addEventListener("scroll", follow, { capture: true, passive: true });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") hide();
  });
}
