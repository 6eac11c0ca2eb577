import { type ReadonlySignal, useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { Icon, IconButton } from "../inputs/button.tsx";
import { Dialog } from "../inputs/dialog.tsx";
import type { Lessons } from "../lessons/lessons.ts";
import { type Model, words } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import type { Address } from "./address.ts";
import { inElement, ownScript, pageOf } from "./page.ts";
import { documentOf } from "./page-state.ts";
import { picture } from "./picture.ts";
import type { PageDocument } from "../document.ts";

/** What a viewer can share. */
export interface Sharing {
  /** The address of the page; null in a notebook, whose address is not the viewer's. */
  address: Address | null;
  /** The document that the viewer was given. */
  own: () => PageDocument | null;
  /** The script of the viewer, if whoever embeds it has it. */
  script: (() => string | undefined) | null;
}

interface Props {
  model: Model;
  palette: ReadonlySignal<Palette>;
  lessons: Lessons;
  sharing: Sharing;
}

/** A button that opens a list: copy the address, save a picture, save the page. */
export function Share({ model, palette, lessons, sharing }: Props) {
  const dialog = useRef<HTMLDialogElement>(null);
  const field = useRef<HTMLInputElement>(null);
  const said = useSignal<{ text: string; failed: boolean } | null>(null);
  const shown = useSignal<string | null>(null);
  const { address } = sharing;

  const act = async (action: () => Promise<string>): Promise<void> => {
    said.value = null;
    try {
      said.value = { text: await action(), failed: false };
    } catch (error) {
      said.value = { text: words(error), failed: true };
    }
  };
  const copy = async (): Promise<string> => {
    shown.value = null;
    if (isLocalServer())
      throw new Error(
        "The address of this page works on this machine alone and has a secret token, so it was not copied. Save the " +
          "page, and send the file.",
      );
    const text = await address!.written(lessons);
    try {
      if (!navigator.clipboard) throw new Error("there is none");
      await navigator.clipboard.writeText(text);
    } catch {
      shown.value = text;
      // After the field is rendered.
      setTimeout(() => field.current?.select());
      throw new Error("The clipboard is not available. Copy the address from the field below.");
    }
    return location.protocol === "file:"
      ? "Address copied. It opens this file with what is shown; others need the file as well."
      : "Address copied. It opens the page with what is shown.";
  };
  const savePicture = async (): Promise<string> => {
    const root = dialog.current!.getRootNode() as ShadowRoot;
    const title = model.page.value === "motion" ? titleOf(model) : "";
    const caption = model.page.value === "motion" ? captionOf(model) : null;
    const name = `${fileName(model)}.png`;
    save(await picture(root, palette.value, title, caption), name);
    return `Picture saved as ${name}.`;
  };
  const savePage = async (): Promise<string> => {
    const given = sharing.script?.();
    const script = given ? inElement(given) : await ownScript();
    const text = await pageOf(await documentOf(model, lessons, sharing.own()), titleOf(model), script);
    const name = `${fileName(model)}.html`;
    save(new Blob([text], { type: "text/html" }), name);
    return `Page saved as ${name}. It needs no server and no network.`;
  };

  return (
    <>
      <IconButton
        id="share"
        class="quiet"
        label="Share"
        icon="share"
        onClick={() => {
          [said.value, shown.value] = [null, null];
          dialog.current?.showModal();
        }}
      />
      <Dialog frame={dialog} name="sharing" title="Share">
        <ul>
          {address && (
            <li>
              <button id="copy-address" autofocus onClick={() => void act(copy)}>
                <Icon name="link" /> Copy the address
              </button>
              <span class="note">
                It holds the scene with its changes, the time, the camera and what is shown.
              </span>
            </li>
          )}
          <li>
            <button id="save-picture" autofocus={!address} onClick={() => void act(savePicture)}>
              <Icon name="picture" /> Save a picture
            </button>
            <span class="note">A PNG of twice the size, with the title and the caption.</span>
          </li>
          <li>
            <button id="save-page" onClick={() => void act(savePage)}>
              <Icon name="page" /> Save the page
            </button>
            <span class="note">One HTML file to send, which others can change as well.</span>
          </li>
        </ul>
        <p class={said.value?.failed ? "said failed" : "said"} aria-live="polite">
          {said.value?.text}
        </p>
        {shown.value !== null && (
          <input
            ref={field}
            id="address"
            type="text"
            readOnly
            aria-label="Address"
            value={shown.value}
            onFocus={(event) => event.currentTarget.select()}
          />
        )}
      </Dialog>
    </>
  );
}

/** Whether the page comes from `polhode view`, or from another server of this machine alone. */
function isLocalServer(): boolean {
  return /^(?:127\.|localhost$|\[::1\])/u.test(location.hostname);
}

function titleOf(model: Model): string {
  return model.about.value?.title ?? "Polhode";
}

function captionOf(model: Model): string | null {
  return model.caption.value ?? model.about.value?.caption ?? null;
}

/** The name of the scene, or of the page of algebra, as that of a file. */
function fileName(model: Model): string {
  return model.page.value === "motion" ? model.source.name.replace(/\.\w+$/u, "") : "algebra";
}

function save(content: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  // Once the browser has begun to write the file.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
