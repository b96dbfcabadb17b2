/* Nodal normals of the nonmortar surface: n_j = m_j / |m_j|, m_j = sum of the unit normals of its edges (outward of a -> b: (t_y, -t_x)); on a symmetry
   plane with unit normal p the mirror images take part, m_j <- 2 (I - p p^T) m_j, so n_j lies in the plane whatever the edges do. */
#include "contactimpl.h"

static PetscErrorCode TopologyEdge_Private(ContactPair pair, PetscInt edge, PetscInt a, PetscInt b)
{
  PetscFunctionBegin;
  PetscCheck(a >= 0 && a < pair->num_nodes && b >= 0 && b < pair->num_nodes && a != b, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "nonmortar edge %" PetscInt_FMT " has nodes %" PetscInt_FMT ", %" PetscInt_FMT ", must differ and lie in [0, %" PetscInt_FMT ")", edge, a, b,
             pair->num_nodes);
  PetscCheck(pair->next[a] < 0 && pair->prev[b] < 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "nonmortar edge %" PetscInt_FMT ": a second edge starts at node %" PetscInt_FMT " or ends at node %" PetscInt_FMT
             ": surface branches or orientations differ",
             edge, a, b);
  pair->next[a] = b;
  pair->prev[b] = a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Neighbours of every node along the surface. */
PetscErrorCode ContactTopologyBuild(ContactPair pair, const ContactSurface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(pair->prev, pair->next));
  PetscCall(PetscFree(pair->normal));
  pair->num_nodes  = s->num_nodes;
  pair->num_facets = s->num_facets;
  PetscCall(PetscMalloc2(s->num_nodes, &pair->prev, s->num_nodes, &pair->next));
  PetscCall(PetscCalloc1(2 * s->num_nodes, &pair->normal));
  for (PetscInt i = 0; i < s->num_nodes; i++) pair->prev[i] = pair->next[i] = -1;
  for (PetscInt e = 0; e < s->num_facets; e++) PetscCall(TopologyEdge_Private(pair, e, s->facets[2 * e], s->facets[2 * e + 1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add the unit normal of edge (a, b) to m. */
static void AddEdgeNormal_Private(const PetscReal a[2], const PetscReal b[2], PetscReal m[2])
{
  const PetscReal w[2] = {b[1] - a[1], a[0] - b[0]}, length = PetscSqrtReal(Dot2(w, w));

  m[0] += w[0] / length;
  m[1] += w[1] / length;
}

static void Mirror_Private(const PetscReal p[2], PetscReal m[2])
{
  const PetscReal along = Dot2(p, m);

  for (int i = 0; i < 2; i++) m[i] = 2 * (m[i] - along * p[i]);
}

static PetscBool HasMirror_Private(const ContactSurface *s, PetscInt node)
{
  return s->mirror && (s->mirror[2 * node] != 0 || s->mirror[2 * node + 1] != 0) ? PETSC_TRUE : PETSC_FALSE;
}

/* Unit normals of all nodes that have an edge; NaN where the node or a neighbour is not known here. *failed: an edge without length, a node whose edge normals
 * cancel (folded surface), or no number. */
PetscErrorCode ContactNormalsBuild(ContactPair pair, const ContactSurface *s, PetscBool *failed)
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < s->num_nodes; j++) {
    const PetscInt prev = pair->prev[j], next = pair->next[j];
    PetscReal      m[2] = {0, 0}, length;

    if (prev < 0 && next < 0) continue;
    if (!ContactHas(s, j) || (prev >= 0 && !ContactHas(s, prev)) || (next >= 0 && !ContactHas(s, next))) {
      for (int i = 0; i < 2; i++) pair->normal[2 * j + i] = NAN;
      continue;
    }
    if (prev >= 0) AddEdgeNormal_Private(&s->x[2 * prev], &s->x[2 * j], m);
    if (next >= 0) AddEdgeNormal_Private(&s->x[2 * j], &s->x[2 * next], m);
    if (HasMirror_Private(s, j)) Mirror_Private(&s->mirror[2 * j], m);
    length = PetscSqrtReal(Dot2(m, m));
    if (!(length > CONTACT_FOLDED)) *failed = PETSC_TRUE; /* also true of NaN */
    for (int i = 0; i < 2; i++) pair->normal[2 * j + i] = m[i] / length;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u = v / |v| with first and second derivatives by v: d = P / |v|, dd_ijk = -(P_ij u_k + P_ik u_j + P_jk u_i) / |v|^2, P = I - u u^T. */
static void UnitDerivative_Private(const PetscReal v[2], PetscReal u[2], PetscReal d[2][2], PetscReal dd[2][2][2])
{
  const PetscReal length = PetscSqrtReal(Dot2(v, v));
  PetscReal       P[2][2];

  for (int i = 0; i < 2; i++) u[i] = v[i] / length;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      P[i][j] = (i == j) - u[i] * u[j];
      d[i][j] = P[i][j] / length;
    }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int k = 0; k < 2; k++) dd[i][j][k] = -(P[i][j] * u[k] + P[i][k] * u[j] + P[j][k] * u[i]) / (length * length);
}

/* Add edge (a, b)'s unit normal and derivatives to m; `at` is a's place among the 6 numbers, b follows. */
static void AddEdgeDerivative_Private(const PetscReal a[2], const PetscReal b[2], int at, NormalDerivative *m)
{
  /* w = (b_y - a_y, a_x - b_x) by (a_x, a_y, b_x, b_y) */
  static const PetscReal dw[2][4] = {{0, -1, 0, 1}, {1, 0, -1, 0}};
  const PetscReal        w[2]     = {b[1] - a[1], a[0] - b[0]};
  PetscReal              u[2], d[2][2], dd[2][2][2];

  UnitDerivative_Private(w, u, d, dd);
  for (int i = 0; i < 2; i++) {
    m->n[i] += u[i];
    for (int p = 0; p < 4; p++) {
      m->d[i][at + p] += d[i][0] * dw[0][p] + d[i][1] * dw[1][p];
      for (int q = 0; q < 4; q++)
        for (int j = 0; j < 2; j++)
          for (int k = 0; k < 2; k++) m->dd[i][at + p][at + q] += dd[i][j][k] * dw[j][p] * dw[k][q];
    }
  }
}

static void MirrorDerivative_Private(const PetscReal p[2], NormalDerivative *m)
{
  PetscReal v[2];

  Mirror_Private(p, m->n);
  for (int a = 0; a < 6; a++) {
    v[0] = m->d[0][a], v[1] = m->d[1][a];
    Mirror_Private(p, v);
    m->d[0][a] = v[0], m->d[1][a] = v[1];
    for (int b = 0; b < 6; b++) {
      v[0] = m->dd[0][a][b], v[1] = m->dd[1][a][b];
      Mirror_Private(p, v);
      m->dd[0][a][b] = v[0], m->dd[1][a][b] = v[1];
    }
  }
}

/* n = m / |m| by the chain rule. */
static void Normalise_Private(const NormalDerivative *m, NormalDerivative *n)
{
  PetscReal d[2][2], dd[2][2][2];

  UnitDerivative_Private(m->n, n->n, d, dd);
  for (int i = 0; i < 2; i++)
    for (int a = 0; a < 6; a++) {
      n->d[i][a] = d[i][0] * m->d[0][a] + d[i][1] * m->d[1][a];
      for (int b = 0; b < 6; b++) {
        PetscReal sum = d[i][0] * m->dd[0][a][b] + d[i][1] * m->dd[1][a][b];

        for (int j = 0; j < 2; j++)
          for (int k = 0; k < 2; k++) sum += dd[i][j][k] * m->d[j][a] * m->d[k][b];
        n->dd[i][a][b] = sum;
      }
    }
}

/* Nodal normal with exact first and second derivatives by (previous node, node, next node); columns of a missing neighbour are zero. */
void ContactNormalDerivative(ContactPair pair, const ContactSurface *s, PetscInt node, NormalDerivative *n)
{
  const PetscInt   prev = pair->prev[node], next = pair->next[node];
  NormalDerivative m;

  memset(&m, 0, sizeof(m));
  if (prev >= 0) AddEdgeDerivative_Private(&s->x[2 * prev], &s->x[2 * node], 0, &m);
  if (next >= 0) AddEdgeDerivative_Private(&s->x[2 * node], &s->x[2 * next], 2, &m);
  if (HasMirror_Private(s, node)) MirrorDerivative_Private(&s->mirror[2 * node], &m);
  Normalise_Private(&m, n);
}

/* Current geometry of one nonmortar edge; normals of the last ContactNormalsBuild. */
void ContactFrame(ContactPair pair, const ContactSurface *s, PetscInt edge, EdgeFrame *f)
{
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++) {
      f->x[k][i] = s->x[2 * s->facets[2 * edge + k] + i];
      f->n[k][i] = pair->normal[2 * s->facets[2 * edge + k] + i];
    }
  for (int i = 0; i < 2; i++) {
    f->dx[i] = f->x[1][i] - f->x[0][i];
    f->dn[i] = f->n[1][i] - f->n[0][i];
  }
  f->length = PetscSqrtReal(Dot2(f->dx, f->dx));
  f->ring   = pair->axisymmetric ? 2 * PETSC_PI : 0;
}
