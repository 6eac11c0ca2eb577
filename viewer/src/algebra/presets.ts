/** Lines to begin with, and what they show. */
export interface AlgebraPreset {
  id: string;
  title: string;
  /** One or two sentences. */
  about: string;
  lines: string;
}

const preset = (id: string, title: string, about: string, ...lines: string[]): AlgebraPreset => ({
  id,
  title,
  about,
  lines: lines.join("\n"),
});

export const ALGEBRA_PRESETS: readonly AlgebraPreset[] = [
  preset(
    "trivector",
    "A trivector is swept out",
    "The vector a sweeps out the bivector a∧b when it moves along b; that sweeps out the trivector (a∧b)∧c when it " +
      "moves along c. The brackets do not matter; an exchange of two vectors turns the sense over.",
    "a = 1.5 e1 - 0.3 e2",
    "b = 0.4 e1 + 1.5 e2",
    "c = 0.3 e1 + 0.4 e2 + 1.2 e3",
    "B = a∧b",
    "T = B∧c",
    "(a∧b)∧c = a∧(b∧c)",
    "a∧b∧c = -b∧a∧c",
  ),
  preset(
    "rotor",
    "A rotor turns a vector",
    "R = exp(−B θ/2) turns every vector by the angle θ in the plane of the unit bivector B, in the sense of B. What a has " +
      "across the plane stays as it is. Turn on with the slider.",
    "θ = 100 deg",
    "B = 0.28 e2∧e3 + 0.96 e1∧e2",
    "a = 1.2 e1 - 0.3 e2 + 0.7 e3",
    "R = exp(-B θ/2)",
    "a' = R a ~R",
    "R ~R = 1",
    "a'·B = R a·B ~R",
  ),
  preset(
    "inertia",
    "The inertia tensor, plane to plane",
    "A body that turns in the plane of B has its angular momentum in the plane of I(B), in general another one. The " +
      "principal planes, and with equal moments all planes, are taken to themselves.",
    "i1 = 2.2",
    "i2 = 1.9",
    "i3 = 0.5",
    "I(X) = -Σ_k i_k X·(I e_k) I e_k",
    "B = 0.4 e2∧e3 + 0.2 e3∧e1 + 1.6 e1∧e2",
    "L = I(B)",
    "½ L·~B  # energy",
    "B×L == 0 e1∧e2  # the same plane?",
  ),
  preset(
    "projection",
    "Projection and rejection",
    "A bivector has an inverse, so a = (a B) B⁻¹ falls into two parts: a·B gives what lies in the plane, a∧B what stands " +
      "across it.",
    "a = 0.3 e1 + 1 e2 + 1.2 e3",
    "B = 0.5 e2∧e3 - 0.3 e3∧e1 + 2 e1∧e2",
    "a∥ = a·B B⁻¹",
    "a⊥ = a∧B B⁻¹",
    "a == a∥ + a⊥",
    "a∥·a⊥ = 0",
  ),
  preset(
    "reflection",
    "A reflection",
    "−n a n⁻¹ is the mirror image of a in the plane across n: what a has along n is turned over, the rest stays.",
    "n = 0.8 e1 + 0.2 e2 + 1.1 e3",
    "a = -0.4 e1 + 1.3 e2 + 0.7 e3",
    "M = 3 I n/norm(n)  # the mirror",
    "b = -n a n⁻¹",
    "b² = a²",
    "a + b == 2 (a∧n) n⁻¹",
  ),
  preset(
    "two-reflections",
    "Two reflections make a rotation",
    "One mirror after the other turns every vector in the plane of their normals, by twice the angle between them. So the " +
      "product of two unit vectors is a rotor.",
    "m = 1.2 e1 - 0.4 e2",
    "n = 0.8 e1 + 0.9 e2",
    "a = 0.9 e1 - 0.7 e2 + 0.9 e3",
    "b = -m a m⁻¹",
    "c = -n b n⁻¹",
    "R = n m/norm(n m)",
    "c == R a ~R",
  ),
  preset(
    "dual",
    "Vectors and planes are dual",
    "Multiplied by I = e1e2e3, a vector becomes the plane across it, and a plane its normal. It does not matter from " +
      "which side, for I commutes with everything.",
    "B = 1.4 e2∧e3 + 0.6 e3∧e1 + 1.6 e1∧e2",
    "b = -I B",
    "I b == B",
    "b == dual(B)",
    "b·B = 0 b",
    "I² = -1",
  ),
  preset(
    "commutator",
    "The commutator of bivectors",
    "A×B = ½(AB − BA) of two planes is a plane across both; it is not the cross product. Where B turns in the plane of A, " +
      "it changes by B×A for each radian.",
    "A = 1.8 e2∧e3",
    "B = 1.2 e3∧e1 + 1.2 e1∧e2",
    "C = A×B",
    "A×B = ½(A B - B A)",
    "(e2∧e3)×(e3∧e1) = -e1∧e2",
    "⟨A C⟩ = 0",
  ),
  preset(
    "cross",
    "The cross product is a dual",
    "The cross product of vectors is the normal of the parallelogram that they span: a ⨯ b = −I a∧b. The parallelogram needs " +
      "no right hand.",
    "a = 1.4 e1 + 0.2 e3",
    "b = 0.4 e1 + 1.2 e2",
    "B = a∧b",
    "v = -I a∧b",
    "v == cross(a, b)",
    "v·a = 0",
  ),
  preset(
    "slerp",
    "From one rotor to another",
    "S goes on from P towards Q, by the shortest turn and at an even pace: at t = 0 it is 1, at t = 1 it takes p to q. The " +
      "logarithm of Q ~P is the bivector of that turn.",
    "t = 0.4",
    "a = 0.9 e1 - 0.9 e2 + 0.4 e3",
    "P = exp(-10 deg e1∧e2)",
    "Q = exp(-65 deg (0.6 e2∧e3 + 0.8 e1∧e2))",
    "p = P a ~P",
    "q = Q a ~Q",
    "S = exp(t log(Q ~P))",
    "r = S p ~S",
    "r == S P a ~P ~S",
  ),
];
