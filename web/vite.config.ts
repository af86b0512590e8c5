import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

// One file that opens from file://: a browser refuses to load module scripts from there, so the script becomes a
// plain one at the end of the body, after the elements and the data it reads.
function singleFile(): Plugin {
  return {
    name: "single-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["report.html"];
      if (page?.type !== "asset") throw new Error("single-file: report.html is not in the bundle");
      let script = "";
      let style = "";
      for (const [name, output] of Object.entries(bundle)) {
        if (output.type === "chunk") script += output.code;
        else if (name.endsWith(".css")) style += String(output.source);
        else continue;
        delete bundle[name];
      }
      // What goes into the page brings its notice; minifying drops the comments of the code.
      const notice = ["uPlot", "three"]
        .map((name) => {
          const text = readFileSync(`node_modules/${name.toLowerCase()}/LICENSE`, "utf8").trim();
          return `This page contains ${name}.\n${text}`;
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

export default defineConfig({
  plugins: [singleFile()],
  build: {
    target: "es2022",
    modulePreload: false,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    rollupOptions: { input: "report.html", output: { format: "iife" } },
  },
});
