import { Problem } from "./core/core.ts";

/** What a page is given to show. Python writes it (`python/polhode/_viewer/document.py`), the page reads it. */
export interface PageDocument {
  /** The version of this form. */
  format: 1;
  /** A scene in TOML; absent where a recorded motion alone is shown. */
  scene?: string;
  /** What the scene is called in messages, `t-handle.toml`. */
  name?: string;
  /** Files that the scene names, gzip in base64. */
  files?: Record<string, string>;
  /** A motion that was followed by Python. */
  recorded?: Recorded;
  /** What to show first; else the motion. */
  page?: "motion" | "algebra";
  /** Lines of the page of algebra. */
  lines?: string;
  /** The state of the page where it is not the usual one. */
  view?: Partial<ViewState>;
}

/** The document that a text says; `where` it stands is named in what is wrong with it. */
export function parsed(text: string, where: string): PageDocument {
  let found: unknown;
  try {
    found = JSON.parse(text);
  } catch (error) {
    throw new Problem(`${where} is not JSON: ${error instanceof Error ? error.message : String(error)}`);
  }
  const format = (found as Partial<PageDocument> | null)?.format;
  if (format === 1) return found as PageDocument;
  throw new Problem(
    format === undefined
      ? `${where} is not a document of this page: it has no format`
      : `${where}: this page reads documents of format 1, not ${String(format)}`,
  );
}

export interface Recorded {
  /** `About` as JSON text, with method `recorded`. */
  about: string;
  /** Rows of states (`State`), little-endian float64, gzip in base64. */
  rows: string;
}

/** What Python and the page tell each other in both directions, beside the scene. */
export interface ViewState {
  time: number;
  playing: boolean;
  /** Seconds of motion in a second of the clock. */
  speed: number;
  camera: CameraName;
  theme: "auto" | "light" | "dark";
  shown: Partial<Shown>;
}

export const CAMERAS = ["oblique", "along e1", "along e2", "along e3", "along L", "with the body"] as const;
export type CameraName = (typeof CAMERAS)[number];

/** What is drawn. */
export interface Shown {
  body: boolean;
  /** f1, f2, f3, which turn with the body. */
  bodyFrame: boolean;
  /** e1, e2, e3. */
  spaceFrame: boolean;
  /** Ω as an oriented disc. */
  omega: boolean;
  /** L as an oriented disc. */
  momentum: boolean;
  /** The axial vectors of Ω and L as arrows, for those who are used to them. */
  axial: boolean;
  /** Poinsot's construction: the inertia ellipsoid on the invariable plane. */
  poinsot: boolean;
  polhode: boolean;
  herpolhode: boolean;
  /** The path of `traced` in space. */
  trace: boolean;
  /** Pivot, weight and the sphere of the locus, of tops. */
  gravity: boolean;
  labels: boolean;
}
