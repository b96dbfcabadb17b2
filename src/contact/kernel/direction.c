/* Directions of the rays at the corners of the nonmortar facets: sums of the vectors of the facets around over their reference measure, with their mirror
   images at planes of symmetry; a corner that hangs on an edge has the mean of its ends, as the interpolation along that edge. Linear in the positions in the
   plane, quadratic in space.

   A direction is single only where the surface is smooth. Facets around a corner that are joined by sides at which the surface turns by less than
   CONTACT_SHARP, at the reference positions, have one direction there (a sheet); beyond a sharper edge each side keeps its own, so that no facet looks round
   the corner at what faces its neighbour. The choice belongs to the mesh: directions are smooth functions of the positions. Directions therefore belong to
   corners of facets: corner k of facet f is number nv f + k. */
#include "kernelimpl.h"

#define DEPTH 6 /* of corners that hang on edges whose ends hang */

typedef struct {
  PetscInt from, to, facet;
} Side;

static int CompareSides_Private(const void *a, const void *b)
{
  const Side *s = (const Side *)a, *t = (const Side *)b;

  if (s->from != t->from) return s->from < t->from ? -1 : 1;
  return (s->to > t->to) - (s->to < t->to);
}

/* All sides of a surface in space, sorted; freed by the caller. */
static PetscErrorCode Sides_Private(const ContactSurface *s, Side **side)
{
  const PetscInt num = 4 * s->num_facets;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, side));
  for (PetscInt k = 0; k < num; k++) (*side)[k] = (Side){s->facets[k], s->facets[4 * (k / 4) + (k + 1) % 4], k / 4};
  qsort(*side, (size_t)num, sizeof(Side), CompareSides_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First side from a node on. */
static PetscInt FirstSide_Private(PetscInt num, const Side side[], PetscInt from)
{
  return SortedFrom(&(Side){.from = from, .to = -1}, side, num, sizeof(Side), CompareSides_Private);
}

static PetscBool HasSide_Private(PetscInt num, const Side side[], PetscInt from, PetscInt to)
{
  return (PetscBool)(bsearch(&(Side){.from = from, .to = to}, side, (size_t)num, sizeof(Side), CompareSides_Private) != NULL);
}

/* Does a node take its position from the facet: it hangs, or is one of its lattice? */
static PetscBool Follows_Private(const ContactSurface *s, PetscInt node, PetscInt facet)
{
  if (s->hang && s->hang[node] < s->hang[node + 1]) return PETSC_TRUE;
  for (PetscInt k = s->order ? s->first[facet] : 0; s->order && k < s->first[facet + 1]; k++)
    if (s->lattice[k] == node) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A side u -> v without partner, against which v -> h -> u run, carries h. */
PetscErrorCode ContactParents(const ContactSurface *s, PetscInt parent[], PetscInt middle[])
{
  const PetscInt num = 4 * s->num_facets;
  Side          *side;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 2 * s->num_nodes; i++) parent[i] = -1;
  for (PetscInt i = 0; i < num && middle; i++) middle[i] = -1;
  if (s->dim == 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Sides_Private(s, &side));
  for (PetscInt k = 0; k < num; k++) {
    const PetscInt u = side[k].from, v = side[k].to;

    if (HasSide_Private(num, side, v, u)) continue;
    for (PetscInt l = FirstSide_Private(num, side, v); l < num && side[l].from == v; l++) {
      const PetscInt h = side[l].to;

      if (!HasSide_Private(num, side, h, u) || !Follows_Private(s, h, side[k].facet)) continue;
      parent[2 * h] = u, parent[2 * h + 1] = v;
      for (PetscInt i = 4 * side[k].facet; i < 4 * (side[k].facet + 1) && middle; i++)
        if (s->facets[i] == u) middle[i] = h;
    }
  }
  PetscCall(PetscFree(side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do both ends of a side lie in one plane of symmetry? (Not in two that are parallel.) */
static PetscBool IsKept_Private(const ContactSurface *s, PetscInt a, PetscInt b)
{
  PetscReal e[3];

  for (int c = 0; c < 3; c++) e[c] = s->X[3 * b + c] - s->X[3 * a + c];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const PetscReal *p = s->mirror + 6 * a + 3 * i, *q = s->mirror + 6 * b + 3 * j;

      if (PetscAbsReal(Dot3(p, q)) > 1 - CONTACT_ROUND && PetscSqr(Dot3(p, e)) < CONTACT_ROUND * Dot3(e, e)) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* ---- sheets -------------------------------------------------------------------------------------------------------------------------- */

/* Unit normal of a facet at a place `at` at the reference positions. */
static void NormalAt_Private(const ContactSurface *s, PetscInt facet, const PetscReal at[2], PetscReal n[3])
{
  ContactSurface reference = *s;
  PetscReal      t[2][3]   = {{0, 0, 0}, {0, 0, 1}}, length;
  RayFunctions   S;
  RayLattice     l;

  if (s->X) reference.x = s->X;
  ContactRayLatticeGather(&reference, facet, &l);
  ContactRayFunctions(s->dim - 1, l.order, at, 1, &S);
  for (PetscInt i = 0; i < s->dim - 1; i++) ContactRayLatticeSum(&l, S.d[i], t[i]);
  Cross3(t[0], t[1], n);
  length = PetscSqrtReal(Dot3(n, n));
  for (int c = 0; c < 3; c++) n[c] /= length;
}

/* The same in the middle of its side from corner k on (plane: at corner k). */
static void SideNormal_Private(const ContactSurface *s, PetscInt facet, PetscInt k, PetscReal n[3])
{
  static const PetscReal Middle[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  const PetscReal        at[2]        = {s->dim == 2 ? 2 * (PetscReal)k - 1 : Middle[k][0], s->dim == 2 ? 0 : Middle[k][1]};

  NormalAt_Private(s, facet, at, n);
}

/* Where corner k of a facet lies on it. */
static const PetscReal *Place_Private(const ContactSurface *s, PetscInt k)
{
  static const PetscReal Corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, End[2][2] = {{-1, 0}, {1, 0}};

  return s->dim == 2 ? End[k] : Corner[k];
}

FacetJoint ContactFacetJoint(const ContactSurface *s, PetscInt a, PetscInt b)
{
  const PetscInt nv = 2 * (s->dim - 1);
  PetscReal      n[2][3];

  for (PetscInt k = 0; k < nv; k++)
    for (PetscInt l = 0; l < nv; l++) {
      if (s->facets[nv * a + k] != s->facets[nv * b + l]) continue;
      NormalAt_Private(s, a, Place_Private(s, k), n[0]);
      NormalAt_Private(s, b, Place_Private(s, l), n[1]);
      return Dot3(n[0], n[1]) > CONTACT_SHARP ? JOINT_SMOOTH : JOINT_SHARP;
    }
  return JOINT_NONE;
}

static void Join_Private(PetscInt sheet[], PetscInt a, PetscInt b)
{
  a = GroupRoot(sheet, a), b = GroupRoot(sheet, b);
  sheet[PetscMax(a, b)] = PetscMin(a, b);
}

/* The corner of the facet at this node, -1: none. */
static PetscInt CornerAt_Private(const ContactSurface *s, PetscInt facet, PetscInt node)
{
  const PetscInt nv = 2 * (s->dim - 1);

  for (PetscInt k = 0; k < nv; k++)
    if (s->facets[nv * facet + k] == node) return nv * facet + k;
  return -1;
}

/* Join the corners of two facets at the nodes of a side they share, or at one end of it where one side is a part of the other. */
static void JoinAlong_Private(RayWork w, const ContactSurface *s, const Side *a, const Side *b)
{
  const PetscInt node[2] = {a->from, a->to};
  PetscReal      n[2][3];

  SideNormal_Private(s, a->facet, CornerAt_Private(s, a->facet, a->from) % 4, n[0]);
  SideNormal_Private(s, b->facet, CornerAt_Private(s, b->facet, b->from) % 4, n[1]);
  if (!(Dot3(n[0], n[1]) > CONTACT_SHARP)) return;
  for (int e = 0; e < 2; e++) {
    const PetscInt i = CornerAt_Private(s, a->facet, node[e]), j = CornerAt_Private(s, b->facet, node[e]);

    if (i >= 0 && j >= 0) Join_Private(w->sheet, i, j);
  }
}

static PetscErrorCode SheetsInSpace_Private(RayWork w, const ContactSurface *s)
{
  const PetscInt num = 4 * s->num_facets;
  Side          *side;

  PetscFunctionBegin;
  PetscCall(Sides_Private(s, &side));
  for (PetscInt k = 0; k < num; k++) {
    for (PetscInt l = FirstSide_Private(num, side, side[k].to); l < num && side[l].from == side[k].to; l++) {
      const PetscInt h = side[l].to;

      if (h == side[k].from || (w->parent[2 * h] == side[k].from && w->parent[2 * h + 1] == side[k].to)) JoinAlong_Private(w, s, &side[k], &side[l]);
      if (w->parent[2 * h] != side[k].from || w->parent[2 * h + 1] != side[k].to) continue;
      for (PetscInt m = FirstSide_Private(num, side, h); m < num && side[m].from == h; m++)
        if (side[m].to == side[k].from) JoinAlong_Private(w, s, &side[k], &side[m]);
    }
  }
  PetscCall(PetscFree(side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void SheetsInPlane_Private(RayWork w, const ContactSurface *s)
{
  for (PetscInt node = 0; node < s->num_nodes; node++)
    for (PetscInt k = w->ring_first[node]; k + 1 < w->ring_first[node + 1]; k++) {
      const PetscInt a = w->ring[k], b = w->ring[k + 1];
      PetscReal      n[2][3];

      SideNormal_Private(s, a / 2, a % 2, n[0]);
      SideNormal_Private(s, b / 2, b % 2, n[1]);
      if (Dot3(n[0], n[1]) > CONTACT_SHARP) Join_Private(w->sheet, a, b);
    }
}

/* Corners of facets on the same sheet around the ends of the edge on which a corner hangs. Where a sharp edge runs into the middle of another only one end may
   be on the sheet: it counts for both. */
static void HangingEnds_Private(RayWork w, const ContactSurface *s, PetscInt corner, PetscInt end[2])
{
  const PetscInt node = s->facets[corner];

  end[0] = end[1] = -1;
  if (w->parent[2 * node] < 0) return;
  for (PetscInt k = w->ring_first[node]; k < w->ring_first[node + 1]; k++)
    for (int e = 0; e < 2 && w->sheet[w->ring[k]] == w->sheet[corner]; e++) {
      const PetscInt at = CornerAt_Private(s, w->ring[k] / 4, w->parent[2 * node + e]);

      if (at >= 0) end[e] = at;
    }
  if (end[0] < 0) end[0] = end[1];
  if (end[1] < 0) end[1] = end[0];
}

static PetscErrorCode Sheets_Private(RayWork w, const ContactSurface *s)
{
  const PetscInt nv = 2 * (s->dim - 1), num = nv * s->num_facets;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; i++) w->sheet[i] = i;
  if (s->dim == 3)
    PetscCall(SheetsInSpace_Private(w, s));
  else
    SheetsInPlane_Private(w, s);
  for (PetscInt i = 0; i < num; i++) w->sheet[i] = GroupRoot(w->sheet, i);
  for (PetscInt i = 0; i < num; i++) HangingEnds_Private(w, s, i, w->end + 2 * i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ContactImageMakesEdge(const ContactSurface *s, PetscInt corner, const PetscReal plane[3])
{
  const PetscInt nv = 2 * (s->dim - 1);
  PetscReal      n[3];

  NormalAt_Private(s, corner / nv, Place_Private(s, corner % nv), n);
  return (PetscBool)(1 - 2 * PetscSqr(Dot3(plane, n)) < CONTACT_SHARP);
}

/* Has a facet no image in plane of symmetry k through one of its corners? It lies along the plane rather than meets it; or with friction makes an edge with the
   image: tractions along both are not those along the mean. -1: its positions are not known here. */
static int8_t HasNoImage_Private(const ContactSurface *s, PetscInt corner, int k, PetscBool friction)
{
  const PetscInt   nv = 2 * (s->dim - 1), node = s->facets[corner];
  const PetscReal *mirror = s->mirror + (s->dim == 2 ? 2 * node : 6 * node + 3 * k), n[3] = {mirror[0], mirror[1], s->dim == 3 ? mirror[2] : 0};
  PetscReal        N[3];

  if (Dot3(n, n) == 0) return 0;
  if (friction && ContactImageMakesEdge(s, corner, n)) return 1;
  ContactFacetVector(s->dim, s->x, s->facets + nv * (corner / nv), N);
  return PetscIsNanReal(Dot3(N, N)) ? -1 : PetscAbsReal(Dot3(n, N)) > STEEP * PetscSqrtReal(Dot3(N, N));
}

void ContactDirectionImages(RayWork w, const ContactSurface *s, PetscBool friction)
{
  for (PetscInt k = 0; k < 4 * (s->dim - 1) * s->num_facets && s->mirror; k++)
    if (w->along[k] < 0) w->along[k] = HasNoImage_Private(s, k / 2, (int)(k % 2), friction);
}

PetscErrorCode ContactDirectionTopology(RayWork w, const ContactSurface *s, PetscBool friction)
{
  const PetscInt nv = s->dim == 2 ? 2 : 4, num = nv * s->num_facets;

  PetscFunctionBegin;
  PetscCall(PetscFree(w->along));
  PetscCall(PetscFree7(w->ring_first, w->ring, w->sheet, w->end, w->parent, w->d, w->kept));
  PetscCall(PetscCalloc7(s->num_nodes + 2, &w->ring_first, num, &w->ring, num, &w->sheet, 2 * num, &w->end, 2 * s->num_nodes, &w->parent, 3 * num, &w->d, num,
                         &w->kept));
  PetscCall(PetscMalloc1(2 * num, &w->along));
  for (PetscInt i = 0; i < num; i++) {
    PetscCheck(s->facets[i] >= 0 && s->facets[i] < s->num_nodes, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "nonmortar facet %" PetscInt_FMT " has node %" PetscInt_FMT ", must lie in [0, %" PetscInt_FMT ")", i / nv, s->facets[i], s->num_nodes);
    w->ring_first[s->facets[i] + 2]++;
  }
  for (PetscInt i = 2; i < s->num_nodes + 2; i++) w->ring_first[i] += w->ring_first[i - 1];
  for (PetscInt i = 0; i < num; i++) w->ring[w->ring_first[s->facets[i] + 1]++] = i;
  for (PetscInt k = 0; k < num && s->dim == 3 && s->mirror; k++) w->kept[k] = IsKept_Private(s, s->facets[k], s->facets[4 * (k / 4) + (k + 1) % 4]);
  for (PetscInt k = 0; k < 2 * num; k++) w->along[k] = -1;
  ContactDirectionImages(w, s, friction);
  PetscCall(ContactParents(s, w->parent, NULL));
  PetscCall(Sheets_Private(w, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- directions ---------------------------------------------------------------------------------------------------------------------- */

/* Mean over the images of a facet in the planes of symmetry through its corner: 1 - n n^T for one, l l^T / l^2 for two with the common line l. */
static void Images_Private(RayWork w, const ContactSurface *s, PetscInt corner, PetscReal R[9])
{
  const PetscInt node    = s->facets[corner];
  PetscReal      n[2][3] = {{0}}, l[3];
  int            num     = 0;

  for (int k = 0; s->mirror && k < (s->dim == 2 ? 1 : 2); k++) {
    for (PetscInt c = 0; c < s->dim; c++) n[num][c] = s->dim == 2 ? s->mirror[2 * node + c] : s->mirror[6 * node + 3 * k + c];
    if (Dot3(n[num], n[num]) > 0 && w->along[2 * corner + k] < 1) num++;
  }
  if (num == 2) {
    Cross3(n[0], n[1], l);
    if (!(Dot3(l, l) > PetscSqr(ROUND_LENGTH))) num = 1;
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      R[3 * i + j] = i == j;
      if (num == 1) R[3 * i + j] = (i == j) - n[0][i] * n[0][j];
      if (num == 2) R[3 * i + j] = l[i] * l[j] / Dot3(l, l);
    }
}

/* Measure of the facets of a sheet around a corner at positions x. Directions are divided by that of the reference positions: of length 1 or so everywhere,
   they change little along graded facets, beyond which they are continued to the images of mortar nodes. */
static PetscReal Around_Private(RayWork w, const ContactSurface *s, PetscInt corner, const PetscReal x[])
{
  const PetscInt nv = s->dim == 2 ? 2 : 4, node = s->facets[corner];
  PetscReal      sum = 0, N[3];

  for (PetscInt k = w->ring_first[node]; k < w->ring_first[node + 1]; k++) {
    if (w->sheet[w->ring[k]] != w->sheet[corner]) continue;
    ContactFacetVector(s->dim, x, s->facets + nv * (w->ring[k] / nv), N);
    sum += PetscSqrtReal(Dot3(N, N));
  }
  return sum;
}

static PetscInt Terms_Private(RayWork w, const ContactSurface *s, PetscInt corner, PetscReal weight, int depth, PetscInt max, DirectionTerm term[])
{
  const PetscInt nv = s->dim == 2 ? 2 : 4, node = s->facets[corner];
  PetscReal      R[9];
  PetscInt       num = 0;

  if (w->end[2 * corner] >= 0 && depth < DEPTH) {
    num = Terms_Private(w, s, w->end[2 * corner], 0.5 * weight, depth + 1, max, term);
    return num + Terms_Private(w, s, w->end[2 * corner + 1], 0.5 * weight, depth + 1, max - num, term + num);
  }
  weight /= Around_Private(w, s, corner, s->X);
  for (PetscInt k = w->ring_first[node]; k < w->ring_first[node + 1] && num < max; k++) {
    if (w->sheet[w->ring[k]] != w->sheet[corner]) continue;
    Images_Private(w, s, w->ring[k], R);
    term[num].facet = w->ring[k] / nv;
    for (int i = 0; i < 9; i++) term[num].R[i] = weight * R[i];
    num++;
  }
  return num;
}

PetscInt ContactDirectionTerms(RayWork w, const ContactSurface *s, PetscInt corner, DirectionTerm term[RAY_TERMS])
{
  return Terms_Private(w, s, corner, 1, 0, RAY_TERMS, term);
}

PetscErrorCode ContactDirectionNodes(RayWork w, const ContactSurface *s, PetscInt corner, Result *r)
{
  const PetscInt nv = 2 * (s->dim - 1);
  DirectionTerm  term[RAY_TERMS];
  const PetscInt terms = ContactDirectionTerms(w, s, corner, term);

  PetscFunctionBegin;
  for (PetscInt t = 0; t < terms; t++)
    for (PetscInt k = 0; k < nv; k++) PetscCall(ContactResultMasters(r, s, s->facets[nv * term[t].facet + k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dN = sum_k dx_k x h_k */
static void VectorRows_Private(const ContactSurface *s, const PetscInt node[], PetscReal h[4][3])
{
  memset(h, 0, 4 * sizeof(h[0]));
  if (s->dim == 2) {
    h[1][2] = 1, h[0][2] = -1;
    return;
  }
  for (int c = 0; c < 3; c++) {
    const PetscReal d = s->x[3 * node[2] + c] - s->x[3 * node[0] + c], e = 0.5 * (s->x[3 * node[3] + c] - s->x[3 * node[1] + c]);

    h[2][c] = e, h[0][c] = -e;
    h[1][c] = 0.5 * d, h[3][c] = -0.5 * d;
  }
}

PetscErrorCode ContactDirectionRows(RayWork w, const ContactSurface *s, PetscInt corner, PetscReal factor, Result *r, PetscReal J[])
{
  const PetscInt D = s->dim, nv = 2 * (D - 1), nn = D * r->num_nodes;
  DirectionTerm  term[RAY_TERMS];
  const PetscInt terms = ContactDirectionTerms(w, s, corner, term);

  PetscFunctionBegin;
  for (PetscInt t = 0; t < terms; t++) {
    const PetscInt *node = s->facets + nv * term[t].facet;
    PetscReal       h[4][3];

    VectorRows_Private(s, node, h);
    for (PetscInt k = 0; k < nv; k++) {
      const PetscReal *g = h[k], X[3][3] = {{0, g[2], -g[1]}, {-g[2], 0, g[0]}, {g[1], -g[0], 0}};
      const PetscReal *weight;
      const PetscInt  *master, masters = ContactNodeRow(s, &node[k], &master, &weight);
      PetscInt         place;

      for (PetscInt i = 0; i < masters; i++) {
        PetscCall(ContactResultNode(r, master[i], &place));
        for (PetscInt c = 0; c < D; c++)
          for (PetscInt j = 0; j < D; j++)
            for (int l = 0; l < 3; l++) J[c * nn + D * place + j] += factor * weight[i] * term[t].R[3 * c + l] * X[l][j];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactDirections(RayWork w, const ContactSurface *s)
{
  const PetscInt nv = s->dim == 2 ? 2 : 4;
  DirectionTerm  term[RAY_TERMS];

  for (PetscInt corner = 0; corner < nv * s->num_facets; corner++) {
    const PetscInt num = ContactDirectionTerms(w, s, corner, term);
    PetscReal     *d   = w->d + 3 * corner;

    d[0] = d[1] = d[2] = 0;
    for (PetscInt k = 0; k < num; k++) {
      PetscReal N[3];

      ContactFacetVector(s->dim, s->x, s->facets + nv * term[k].facet, N);
      for (int i = 0; i < 3; i++) d[i] += Dot3(term[k].R + 3 * i, N);
    }
  }
}

/* False where the vectors around a corner cancel. */
PetscBool ContactDirectionUsable(RayWork w, const ContactSurface *s, PetscInt corner)
{
  const PetscReal *d = w->d + 3 * corner;

  return (PetscBool)(PetscSqrtReal(Dot3(d, d)) * Around_Private(w, s, corner, s->X) > ROUND_LENGTH * Around_Private(w, s, corner, s->x));
}
