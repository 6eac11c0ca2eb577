import { Problem } from "../core/core.ts";
import type { PageDocument } from "../document.ts";
import template from "../../../python/polhode/_viewer/page.html?raw";
import { base64 } from "./packing.ts";

/** A self-contained page with a document and a script, as `python/polhode/_viewer/html.py` writes it. */
export async function pageOf(document: PageDocument, title: string, script: string): Promise<string> {
  if (!isSecureContext) {
    throw new Problem(
      "the page cannot be saved here: it needs a checksum, which browsers give over https only",
    );
  }
  const digest = await crypto.subtle.digest("SHA-256", new TextEncoder().encode(script));
  const parts: Record<string, string> = {
    digest: base64(new Uint8Array(digest)),
    title: escaped(title),
    attributes: " titled",
    data: JSON.stringify(document).replaceAll("<", "\\u003c"),
    script,
  };
  return template.replaceAll(/\$\{(\w+)\}/gu, (_, name: string) => parts[name] ?? "");
}

/** The script of the viewer as a page has it inside an element: from this page, or from the file that it loaded. */
export async function ownScript(): Promise<string> {
  const inside = [...document.querySelectorAll("script")]
    .filter(({ src, type }) => src === "" && type === "module")
    .find(({ textContent }) => textContent.includes("polhode-viewer"));
  if (inside) return inside.textContent;
  try {
    const answer = await fetch(import.meta.url);
    if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
    return inElement(await answer.text());
  } catch (error) {
    throw new Problem(
      `the page cannot be saved here: the script of the viewer cannot be read (${String(error)})`,
    );
  }
}

/** A script so that nothing in it closes its element: see `_inline` in html.py. */
export function inElement(script: string): string {
  return `\n${script.replaceAll(/<(?=\/script)/giu, "\\x3C")}`;
}

function escaped(text: string): string {
  const names: Record<string, string> = {
    "&": "&amp;",
    "<": "&lt;",
    ">": "&gt;",
    '"': "&quot;",
    "'": "&#x27;",
  };
  return text.replaceAll(/[&<>"']/gu, (letter) => names[letter]!);
}
