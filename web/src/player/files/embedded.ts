// The recordings that weft export --html has put into the page.
import { fromBase64 } from "./bytes";
import type { GivenFile } from "./sources";

export function embeddedFiles(): GivenFile[] {
  const elements = document.querySelectorAll<HTMLScriptElement>('script[type="application/x-weft-recording"]');
  return [...elements].map((element) => {
    const main = fromBase64(element.textContent ?? "");
    element.remove(); // the text is not needed twice
    return { name: element.dataset["name"] ?? "recording", main, log: null };
  });
}
