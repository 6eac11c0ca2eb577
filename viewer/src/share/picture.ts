import { Problem } from "../core/core.ts";
import type { Palette } from "../palette.ts";
import { pictureIn } from "../stage/viewport.ts";

/** Pixels per CSS pixel. */
const SCALE = 2;
/** CSS pixels around the texts, and of a line of them. */
const MARGIN = 16;
const LINE = 22;
const FAMILY = '"STIX Two Text", Cambria, "Times New Roman", "Liberation Serif", serif';

/** The pictures of a page at twice their size, with the title above and the caption below them, as a PNG. */
export async function picture(
  root: ParentNode,
  palette: Palette,
  title: string,
  caption: string | null,
): Promise<Blob> {
  const parts = [...root.querySelectorAll<HTMLElement>(".stage, .energy, .drawn")].flatMap((host) => {
    const drawn = pictureIn(host, SCALE);
    return drawn ? [{ drawn, box: host.getBoundingClientRect() }] : [];
  });
  if (parts.length === 0) throw new Problem("there is no picture to save: this browser draws no 3-d picture");
  const left = Math.min(...parts.map(({ box }) => box.left));
  const top = Math.min(...parts.map(({ box }) => box.top));
  const width = Math.max(...parts.map(({ box }) => box.right)) - left;
  const height = Math.max(...parts.map(({ box }) => box.bottom)) - top;

  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d")!;
  const heading = `600 18px ${FAMILY}`;
  const text = `italic 16px ${FAMILY}`;
  const titled = lines(context, heading, title, width - 2 * MARGIN);
  const captioned = lines(context, text, caption ?? "", width - 2 * MARGIN);
  const above = room(titled);
  canvas.width = Math.round(width * SCALE);
  canvas.height = Math.round((above + height + room(captioned)) * SCALE);
  context.fillStyle = palette.background;
  context.fillRect(0, 0, canvas.width, canvas.height);
  for (const { drawn, box } of parts) {
    context.drawImage(drawn, (box.left - left) * SCALE, (above + box.top - top) * SCALE);
  }
  context.scale(SCALE, SCALE);
  context.fillStyle = palette.text;
  write(context, heading, titled, 0);
  write(context, text, captioned, above + height);
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => {
      if (blob) resolve(blob);
      else reject(new Problem(`the picture is too large: ${canvas.width} × ${canvas.height} pixels`));
    }, "image/png");
  });
}

/** The words of a text in lines of at most this width. */
function lines(context: CanvasRenderingContext2D, font: string, text: string, width: number): string[] {
  context.font = font;
  const found: string[] = [];
  for (const word of text.split(/\s+/u).filter(Boolean)) {
    const longer = found.length > 0 ? `${found.at(-1)} ${word}` : word;
    if (found.length > 0 && context.measureText(longer).width <= width) found[found.length - 1] = longer;
    else found.push(word);
  }
  return found;
}

function room({ length }: readonly string[]): number {
  return length === 0 ? 0 : length * LINE + MARGIN;
}

function write(context: CanvasRenderingContext2D, font: string, texts: readonly string[], top: number): void {
  context.font = font;
  texts.forEach((text, k) => context.fillText(text, MARGIN, top + MARGIN / 2 + LINE * (k + 0.72)));
}
