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
    here.xy += vec2(-tangent.y, tangent.x) * along.x * miter * width / screen * here.w;
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
  private readonly now = { value: 0 };
  private readonly fades = { value: false };
  private readonly meshes: Mesh[] = [];

  constructor(screen: Screen, colour: ColorRepresentation, style: RibbonStyle) {
    const color = { value: new Color(colour) };
    const opacity = style.opacity ?? 1;
    const passes: [number, typeof LessEqualDepth | typeof GreaterDepth][] = [[opacity, LessEqualDepth]];
    if (style.behind) passes.push([opacity * style.behind, GreaterDepth]);
    for (const [seen, depthFunc] of passes) {
      const material = new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: {
          screen,
          width: { value: style.width },
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
    const { parameters, closed = false } = options;
    const given = points.length;
    this.count = given + (closed && given > 0 ? 1 : 0);
    // An additional point at each end: the shader needs the neighbours of each point.
    const index = (row: number): number =>
      closed ? (row - 1 + given) % given : Math.min(Math.max(row - 1, 0), given - 1);
    const data = new Float32Array((this.count + 2) * 2 * STRIDE);
    let length = 0;
    for (let row = 0; row < this.count + 2 && given > 0; row++) {
      const here = points[index(row)]!;
      if (row > 1) length += here.distanceTo(points[index(row - 1)]!);
      const parameter = parameters ? parameters[index(row)]! : length;
      data.set([...here, -1, parameter, ...here, 1, parameter], 2 * STRIDE * row);
    }
    this.fades.value = false;
    const seen = this.count > 1;
    const geometry = seen ? strip(new InterleavedBuffer(data, STRIDE), this.count) : new BufferGeometry();
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.geometry = geometry;
      mesh.visible = seen;
    }
  }

  /** Sets the parameter at which the line is most opaque. */
  fade(now: number): void {
    this.fades.value = true;
    this.now.value = now;
  }
}

/** A strip of triangles. The neighbours of a point are in the same buffer, two vertices before and after. */
function strip(vertices: InterleavedBuffer, count: number): BufferGeometry {
  const geometry = new BufferGeometry();
  const index = new Uint32Array(6 * (count - 1));
  for (let k = 0; k < count - 1; k++) {
    const a = 2 * k;
    index.set([a, a + 1, a + 2, a + 2, a + 1, a + 3], 6 * k);
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
