import {
  Color,
  type ColorRepresentation,
  DoubleSide,
  GreaterDepth,
  Group,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  BufferAttribute,
  BufferGeometry,
  LessEqualDepth,
  Mesh,
  ShaderMaterial,
  Sphere,
  type Vector2,
  type Vector3,
} from "three";

import type { CurveName } from "../model/model.ts";
import type { Curve } from "./curves.ts";

/** The size of the canvas in CSS pixels, shared by all ribbons of a stage. */
export interface Screen {
  value: Vector2;
}

const VERTEX = /* glsl */ `
  attribute vec3 before;
  attribute vec3 after;
  attribute vec2 along;
  uniform vec2 screen;
  uniform float width;
  // A factor of the width, for emphasis.
  uniform float weight;
  varying float parameter;

  vec2 direction(vec2 to) {
    return dot(to, to) > 1e-8 ? normalize(to) : vec2(0.0);
  }

  void main() {
    mat4 onto = projectionMatrix * modelViewMatrix;
    vec4 here = onto * vec4(position, 1.0);
    vec4 from = onto * vec4(before, 1.0);
    vec4 to = onto * vec4(after, 1.0);
    vec2 middle = here.xy / here.w;
    vec2 coming = direction((middle - from.xy / from.w) * screen);
    vec2 going = direction((to.xy / to.w - middle) * screen);
    vec2 along2 = coming + going;
    vec2 tangent = dot(along2, along2) > 1e-3 ? normalize(along2) : direction(coming - going);
    // At a bend the ribbon is wider along the bisector, at a cusp infinitely wide: limited.
    float bend = max(dot(tangent, going), dot(tangent, coming));
    float miter = 1.0 / max(bend, 0.6);
    here.xy += vec2(-tangent.y, tangent.x) * along.x * miter * width * weight / screen * here.w;
    parameter = along.y;
    gl_Position = here;
  }
`;

const FRAGMENT = /* glsl */ `
  uniform vec3 color;
  uniform float opacity;
  uniform float now;
  uniform bool fades;
  uniform float dash;
  varying float parameter;

  void main() {
    float alpha = opacity;
    if (fades) {
      float age = now - parameter;
      float left = clamp(1.0 - abs(age), 0.0, 1.0);
      alpha *= (age >= 0.0 ? left : 0.22) * left;
    }
    if (dash > 0.0 && fract(parameter / dash) > 0.55) discard;
    if (alpha < 0.004) discard;
    gl_FragColor = vec4(color, alpha);
    #include <colorspace_fragment>
  }
`;

/** How much wider a marked line is, and the age up to which a fading one is seen well enough to be pointed at. */
const MARKED = 2;
const VISIBLE = 0.9;
/** Values per vertex: the point, the side (−1 or 1) and the parameter. */
const STRIDE = 5;

export interface RibbonStyle {
  /** CSS pixels. */
  width: number;
  opacity?: number;
  /** Opacity of hidden parts, relative to `opacity`. */
  behind?: number;
  /** Length of a dash and its gap, in units of the parameter. */
  dash?: number;
  order?: number;
}

/**
 * A line of constant width in pixels: one strip of triangles, joined at the bends, so that translucent lines have no
 * dark dots between segments. It can fade with a parameter along the line: from `now` back over one unit, and
 * paler forward over one.
 */
export class Ribbon {
  readonly object = new Group();
  /** Number of points. */
  count = 0;
  private vertices: InterleavedBuffer | null = null;
  private readonly usual: number;
  private readonly width: { value: number };
  private readonly now = { value: 0 };
  private readonly fades = { value: false };
  private readonly meshes: Mesh[] = [];

  constructor(screen: Screen, colour: ColorRepresentation, style: RibbonStyle) {
    const color = { value: new Color(colour) };
    this.width = { value: style.width };
    this.usual = style.width;
    const opacity = style.opacity ?? 1;
    const passes: [number, typeof LessEqualDepth | typeof GreaterDepth][] = [[opacity, LessEqualDepth]];
    if (style.behind) passes.push([opacity * style.behind, GreaterDepth]);
    for (const [seen, depthFunc] of passes) {
      const material = new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: {
          screen,
          width: this.width,
          weight: { value: 1 },
          color,
          opacity: { value: seen },
          now: this.now,
          fades: this.fades,
          dash: { value: style.dash ?? 0 },
        },
        transparent: true,
        depthWrite: false,
        depthFunc,
        side: DoubleSide,
      });
      const mesh = new Mesh(new BufferGeometry(), material);
      mesh.frustumCulled = false;
      mesh.renderOrder = style.order ?? 2;
      mesh.visible = false;
      this.meshes.push(mesh);
      this.object.add(mesh);
    }
  }

  /** Sets the points and their parameters, by default the length of the line up to them. */
  set(points: readonly Vector3[], options: { parameters?: readonly number[]; closed?: boolean } = {}): void {
    const numbers = new Float64Array(3 * points.length);
    points.forEach((point, k) => point.toArray(numbers, 3 * k));
    this.setNumbers(numbers, options);
  }

  /** `set` for points as numbers (n × 3). The buffers are kept while the number of points is the same. */
  setNumbers(
    points: Float64Array,
    { parameters, closed = false }: { parameters?: ArrayLike<number>; closed?: boolean } = {},
  ): void {
    const given = points.length / 3;
    const count = given + (closed && given > 0 ? 1 : 0);
    const old = count === this.count ? this.vertices : null;
    this.count = count;
    const vertices = old ?? new InterleavedBuffer(new Float32Array((count + 2) * 2 * STRIDE), STRIDE);
    fill(vertices.array as Float32Array, count, points, closed, parameters);
    this.fades.value = false;
    if (old) {
      old.needsUpdate = true;
      return;
    }
    const seen = count > 1;
    this.vertices = seen ? vertices : null;
    const geometry = seen ? strip(vertices, count) : new BufferGeometry();
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.geometry = geometry;
      mesh.visible = seen;
    }
  }

  /** As a curve that can be pointed at. */
  curve(name: CurveName): Curve {
    return {
      name,
      object: this.object,
      mark: (marked) => (this.width.value = this.usual * (marked ? MARKED : 1)),
      visit: (point) => {
        const numbers = this.vertices?.array ?? [];
        for (let row = 1; row <= this.count; row++) {
          const at = 2 * STRIDE * row;
          const age = this.fades.value ? Math.abs(this.now.value - numbers[at + 4]!) : 0;
          if (age < VISIBLE) point(numbers[at]!, numbers[at + 1]!, numbers[at + 2]!, row > 1);
        }
      },
    };
  }

  /** Sets the parameter at which the line is most opaque. */
  fade(now: number): void {
    this.fades.value = true;
    this.now.value = now;
  }
}

/** Fills the vertices of a line: one more point at each end, because the shader needs the neighbours of each. */
function fill(
  into: Float32Array,
  count: number,
  points: Float64Array,
  closed: boolean,
  parameters?: ArrayLike<number>,
): void {
  const given = points.length / 3;
  if (given === 0) return;
  let length = 0;
  let before = 0;
  for (let row = 0; row < count + 2; row++) {
    const point = closed ? (row - 1 + given) % given : Math.min(Math.max(row - 1, 0), given - 1);
    const [at, last] = [3 * point, 3 * before];
    const [x, y, z] = [points[at]!, points[at + 1]!, points[at + 2]!];
    if (row > 1) length += Math.hypot(x - points[last]!, y - points[last + 1]!, z - points[last + 2]!);
    before = point;
    const parameter = parameters ? parameters[point]! : length;
    for (let side = 0; side < 2; side++) {
      const place = STRIDE * (2 * row + side);
      into[place] = x;
      into[place + 1] = y;
      into[place + 2] = z;
      into[place + 3] = 2 * side - 1;
      into[place + 4] = parameter;
    }
  }
}

/** A strip of triangles. The neighbours of a point are in the same buffer, two vertices before and after. */
function strip(vertices: InterleavedBuffer, count: number): BufferGeometry {
  const geometry = new BufferGeometry();
  const index = new Uint32Array(6 * (count - 1));
  for (let k = 0; k < count - 1; k++) {
    const [a, at] = [2 * k, 6 * k];
    index[at] = a;
    index[at + 1] = index[at + 4] = a + 1;
    index[at + 2] = index[at + 3] = a + 2;
    index[at + 5] = a + 3;
  }
  geometry.setAttribute("before", new InterleavedBufferAttribute(vertices, 3, 0));
  geometry.setAttribute("position", new InterleavedBufferAttribute(vertices, 3, 2 * STRIDE));
  geometry.setAttribute("along", new InterleavedBufferAttribute(vertices, 2, 2 * STRIDE + 3));
  geometry.setAttribute("after", new InterleavedBufferAttribute(vertices, 3, 4 * STRIDE));
  geometry.setIndex(new BufferAttribute(index, 1));
  // Needed for the drawing order only; computing it would read beyond the end of the buffer.
  geometry.boundingSphere = new Sphere();
  return geometry;
}
