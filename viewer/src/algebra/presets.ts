/** Example lines with a description. */
interface AlgebraPreset {
  id: string;
  title: string;
  /** One or two sentences. */
  about: string;
  lines: string;
}

/** A preset; its lines are separated by semicolons. */
const preset = (id: string, title: string, about: string, lines: string): AlgebraPreset => ({
  id,
  title,
  about,
  lines: lines.replaceAll("; ", "\n"),
});

export const ALGEBRA_PRESETS: readonly AlgebraPreset[] = [
  preset(
    "trivector",
    "A trivector as a swept volume",
    "The vector a sweeps out the bivector a∧b when it moves along b, and a∧b sweeps out the trivector (a∧b)∧c " +
      "when it moves along c. The wedge product is associative; exchanging two vectors reverses the " +
      "orientation.",
    "a = 1.5 e1 - 0.3 e2; b = 0.4 e1 + 1.5 e2; c = 0.3 e1 + 0.4 e2 + 1.2 e3; B = a∧b; T = B∧c; " +
      "(a∧b)∧c = a∧(b∧c); a∧b∧c = -b∧a∧c",
  ),
  preset(
    "rotor",
    "A rotor turns a vector",
    "R = exp(−B θ/2) turns every vector by the angle θ in the plane of the unit bivector B, in the sense of " +
      "B. The part of a that is perpendicular to the plane does not change. Change θ with the slider.",
    "θ = 100 deg; B = 0.28 e2∧e3 + 0.96 e1∧e2; a = 1.2 e1 - 0.3 e2 + 0.7 e3; R = exp(-B θ/2); a' = R a ~R; " +
      "R ~R = 1; a'·B = R a·B ~R",
  ),
  preset(
    "inertia",
    "The inertia map takes planes to planes",
    "A body that rotates in the plane of B has its angular momentum in the plane of I(B), which is in general " +
      "a different one. Only principal planes are mapped to themselves; with equal moments all planes are " +
      "principal.",
    "i1 = 2.2; i2 = 1.9; i3 = 0.5; I(X) = -Σ_k i_k X·(I e_k) I e_k; B = 0.4 e2∧e3 + 0.2 e3∧e1 + 1.6 e1∧e2; " +
      "L = I(B); ½ L·~B  # energy; B×L == 0 e1∧e2  # the same plane?",
  ),
  preset(
    "projection",
    "Projection and rejection",
    "A bivector has an inverse, so a = (a B) B⁻¹ splits into two parts: a·B gives the part in the plane, and " +
      "a∧B the part perpendicular to it.",
    "a = 0.3 e1 + 1 e2 + 1.2 e3; B = 0.5 e2∧e3 - 0.3 e3∧e1 + 2 e1∧e2; a∥ = a·B B⁻¹; a⊥ = a∧B B⁻¹; " +
      "a == a∥ + a⊥; a∥·a⊥ = 0",
  ),
  preset(
    "reflection",
    "A reflection",
    "−n a n⁻¹ is the mirror image of a in the plane perpendicular to n: the part along n changes sign, the " +
      "rest does not.",
    "n = 0.8 e1 + 0.2 e2 + 1.1 e3; a = -0.4 e1 + 1.3 e2 + 0.7 e3; M = 3 I n/norm(n)  # the mirror; " +
      "b = -n a n⁻¹; b² = a²; a + b == 2 (a∧n) n⁻¹",
  ),
  preset(
    "two-reflections",
    "Two reflections make a rotation",
    "Two reflections turn every vector in the plane of the two normals by twice the angle between them. So " +
      "the product of two unit vectors is a rotor.",
    "m = 1.2 e1 - 0.4 e2; n = 0.8 e1 + 0.9 e2; a = 0.9 e1 - 0.7 e2 + 0.9 e3; b = -m a m⁻¹; c = -n b n⁻¹; " +
      "R = n m/norm(n m); c == R a ~R",
  ),
  preset(
    "dual",
    "Vectors and planes are dual",
    "Multiplication by I = e1e2e3 takes a vector to the plane perpendicular to it, and a plane to its normal, " +
      "from either side, because I commutes with everything.",
    "B = 1.4 e2∧e3 + 0.6 e3∧e1 + 1.6 e1∧e2; b = -I B; I b == B; b == dual(B); b·B = 0 b; I² = -1",
  ),
  preset(
    "commutator",
    "The commutator of bivectors",
    "A×B = ½(AB − BA) of two planes is a plane perpendicular to both; it is not the cross product. If B " +
      "rotates in the plane of A, it changes by B×A per radian.",
    "A = 1.8 e2∧e3; B = 1.2 e3∧e1 + 1.2 e1∧e2; C = A×B; A×B = ½(A B - B A); (e2∧e3)×(e3∧e1) = -e1∧e2; " +
      "⟨A C⟩ = 0",
  ),
  preset(
    "cross",
    "The cross product is a dual",
    "The cross product of vectors is the normal of the parallelogram that they span: a ⨯ b = −I a∧b. The " +
      "parallelogram itself needs no right-hand rule.",
    "a = 1.4 e1 + 0.2 e3; b = 0.4 e1 + 1.2 e2; B = a∧b; v = -I a∧b; v == cross(a, b); v·a = 0",
  ),
  preset(
    "slerp",
    "Interpolation of rotors",
    "S turns from P towards Q by the shortest rotation at a constant rate: at t = 0 it is 1, at t = 1 it " +
      "takes p to q. The logarithm of Q ~P is the bivector of that rotation.",
    "t = 0.4; a = 0.9 e1 - 0.9 e2 + 0.4 e3; P = exp(-10 deg e1∧e2); " +
      "Q = exp(-65 deg (0.6 e2∧e3 + 0.8 e1∧e2)); p = P a ~P; q = Q a ~Q; S = exp(t log(Q ~P)); r = S p ~S; " +
      "r == S P a ~P ~S",
  ),
];
