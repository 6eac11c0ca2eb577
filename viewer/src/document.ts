import { Problem } from "./core/core.ts";

/** A document for the page to show, written by `python/polhode/_viewer/document.py`. */
export interface PageDocument {
  /** The version of this format. */
  format: 1;
  /** A scene in TOML; absent for a recorded motion alone. */
  scene?: string;
  /** The name of the scene in messages, such as `t-handle.toml`. */
  name?: string;
  /** Files that the scene refers to, gzip in base64. */
  files?: Record<string, string>;
  /** A motion computed by Python. */
  recorded?: {
    /** `About` as JSON text, with method `recorded`. */
    about: string;
    /** Rows of states (`State`), little-endian float64, gzip in base64. */
    rows: string;
  };
  /** The page to show first; by default the motion. */
  page?: "motion" | "algebra";
  /** Lines of the algebra page. */
  lines?: string;
  /** Values that the algebra page draws beside those of its lines. */
  values?: GivenValue[];
  /** The caption of the picture, instead of that of the scene. */
  caption?: string;
  /**
   * A lesson in Markdown, which sets what the page shows; its own scenes and meshes are in `files`. `scene` and `view`
   * are then what was changed in its step.
   */
  lesson?: { text: string; name: string; step?: number };
  /** Differences from the default view. */
  view?: Partial<ViewState>;
}

/** A lesson, the files that it refers to, and the number of the step to begin with, from 0. */
export interface LessonFile {
  text: string;
  name: string;
  files?: ReadonlyMap<string, Uint8Array>;
  step?: number;
  /** The text of the scene and the view, where they differ from those that the step sets. */
  changed?: { scene?: string; view?: Partial<ViewState> };
}

/** A value of projective or conformal geometry, as Python wrote and measured it; a batch has a shape per element. */
export interface GivenValue {
  name: string;
  /** What it is, such as `plane` or `100 points`. */
  kind: string;
  /** The value in its blades. */
  text: string;
  shapes: Shape[];
}

type Numbers = [number, number, number];

/** What is drawn of a value, in the units of the coordinates. Directions and normals have length 1. */
export type Shape =
  | { kind: "point"; at: Numbers }
  | { kind: "direction"; along: Numbers }
  | { kind: "line"; at: Numbers; along: Numbers }
  | { kind: "plane"; at: Numbers; normal: Numbers }
  | { kind: "sphere"; at: Numbers; radius: number }
  | { kind: "circle"; at: Numbers; normal: Numbers; radius: number }
  /** A rotation by an angle about an axis through `at`, and a translation by `shift` along it. */
  | { kind: "screw"; at: Numbers; along: Numbers; angle: number; shift: number };

/** Parses a document; errors begin with `where` it comes from. */
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
      ? `${where} is not a viewer document: it has no format`
      : `${where}: this page reads documents of format 1, not ${String(format)}`,
  );
}

/** The view, synchronised between Python and the page. */
export interface ViewState {
  time: number;
  playing: boolean;
  /** Seconds of motion per second. */
  speed: number;
  camera: CameraName;
  /** Where the camera was turned to from its preset. */
  pose?: Pose;
  theme: "auto" | "light" | "dark";
  shown: Partial<Shown>;
}

export const CAMERAS = ["oblique", "along e1", "along e2", "along e3", "along L", "with the body"] as const;
export type CameraName = (typeof CAMERAS)[number];

/** A place of the camera: azimuth and elevation in degrees, and the nearness, 1 at the distance of presets. */
export type Pose = readonly [azimuth: number, elevation: number, nearness: number];

/** Visibility of the parts of the picture. */
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
  /** The torque as an oriented disc. */
  torque: boolean;
  /** What the laws depend on: field, dipole, directions to the planet and the sun, wheel, thrusts. */
  sources: boolean;
  /** The axial vectors of the discs that are shown as arrows; of both without discs. */
  axial: boolean;
  /** Poinsot's construction: the inertia ellipsoid on the invariable plane. */
  poinsot: boolean;
  polhode: boolean;
  herpolhode: boolean;
  /** The path of a body axis in space. */
  trace: boolean;
  /** The energy ellipsoid of a free body with its polhodes, in a second picture. */
  energy: boolean;
  /** A second body whose Ω at the start is 0.1° from that of the first. */
  ghost: boolean;
  /** Pivot, weight and the sphere of the locus, for tops. */
  gravity: boolean;
  labels: boolean;
}
