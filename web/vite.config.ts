import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

// What goes into a page brings its notice; minifying drops the comments of the code.
const NOTICES: Record<string, Record<string, string>> = {
  report: { uPlot: "uplot", three: "three" },
  player: {
    uPlot: "uplot",
    three: "three",
    "sql.js": "sql.js",
    fzstd: "fzstd",
    "hash-wasm": "hash-wasm",
    "smol-toml": "smol-toml",
  },
};

// One file that opens from file://: a browser refuses to load module scripts from there, so the script becomes a
// plain one at the end of the body, after the elements and the data it reads.
function singleFile(name: string): Plugin {
  return {
    name: "single-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle[`${name}.html`];
      if (page?.type !== "asset") throw new Error(`single-file: ${name}.html is not in the bundle`);
      let script = "";
      let style = "";
      for (const [name, output] of Object.entries(bundle)) {
        if (output.type === "chunk") script += output.code;
        else if (name.endsWith(".css")) style += String(output.source);
        else continue;
        delete bundle[name];
      }
      const notice = Object.entries(NOTICES[name] ?? {})
        .map(([title, folder]) => {
          const text = readFileSync(`node_modules/${folder}/LICENSE`, "utf8").trim();
          return `This page contains ${title}.\n${text.replaceAll("--", "-")}`;
        })
        .join("\n\n");
      const html = String(page.source)
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace("<head>", () => `<!--\n${notice}\n-->\n<head>`)
        .replace("</head>", () => `<style>${style.trim()}</style>\n</head>`)
        .replace(
          "</body>",
          () => `<script>${script.trim().replaceAll("</script", "<\\/script")}</script>\n</body>`,
        );
      if (/<script[^>]* src=|<link[^>]* href="(?!data:)/.test(html))
        throw new Error("single-file: a link is left");
      page.source = html;
    },
  };
}

// Each page is a build of its own: vite build --mode report, vite build --mode player.
export default defineConfig(({ mode }) => ({
  plugins: [singleFile(mode)],
  build: {
    target: "es2022",
    emptyOutDir: false,
    modulePreload: false,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    rollupOptions: { input: `${mode}.html`, output: { format: "iife" } },
  },
}));
