/* Private to contact. Multiplier functions of a nonmortar surface whose facets have any order, one constant matrix per facet.

   Notation. N_a: Lagrange functions of a facet's Gauss-Lobatto lattice; P: rows of its nodes by true nodes (those that do not hang); chi = P^T N the true basis
   on the facet. Measure: that of the reference configuration (axisymmetric: times 2 pi R), so nothing here depends on the deformation.

   Plain facets (no corner hangs; nodes on sides of lower order may): the element-wise dual of the constrained basis,
     psi = diag(int chi) M^-1 chi,   M = int chi chi^T.
   On an affine facet on which nothing hangs these are products of phi_j + L_p / (p L_p(xi_j)), L_p Legendre.
   Facets with a corner that hangs: *macro dual*. Fine facets that hang on the same coarse edge (they share the corner in its middle) are united, E, and psi =
   diag(int_E chi) M_E^-1 chi: every true node of E has a row on every facet of E. The corner in the middle of a coarse edge must hang even where a node of the
   edge lies at the same place (weight 1).
   Where the facets of E have different orders, or where E lacks one of the two facets on a hanging edge, or chi is linearly dependent on E: P^T psi_L with the
   dual functions psi_L of each lattice: sum 1 and polynomials are exact there, int psi_j chi_k is not diagonal.
   Standard: psi = chi.

   Nodes that carry nothing (supports hold them; on the axis from order 2 on, where int chi_j R dR = 0): their functions go to the others of the facet or of E
   with the weights of a polynomial extrapolation of degree p - 1 to the node (extrapolate.c; p the least order), for standard functions too: dropped functions
   would lose sum psi = 1 and all rates. At p = 1 that is constants: an edge with a held end has psi = 1 at the other, of a quadrilateral with a held side each
   held node's function goes to the node across, that of a lone corner by halves to its neighbours. The degree is lowered where otherwise int psi_j over the
   whole surface fell below a tenth of int chi_j (even orders: the far end of a held facet gets 0 from it). int psi_j chi_k stays diagonal among nodes that
   carry. A facet (or E) without nodes that carry has no functions. A node without any row has no multiplier.

   Bernstein functions, for facets that are covered in part (blend.c): those of the facet's order, at nodes of its lattice; of a node that hangs in the ratio of
   the positive weights of its row, of one that carries nothing in that of the positive weights of the extrapolation. They are positive and sum to 1. */
#pragma once
#include "contactimpl.h"
#include "element.h"

#define MULTIPLIER_LATTICE ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1)) /* most nodes of a facet */

/* psi_row = sum_a T[offset[f] + (row - row_first[f]) * num_lattice + a] N_a on facet f, rows row_first[f] .. row_first[f+1], lattice lexicographic (order 1
   without lattice: corners 0, 1, 3, 2). */
typedef struct ContactMultiplier {
  PetscInt   num_facets;
  PetscInt  *row_first; /* [num_facets+1] */
  PetscInt  *row_node;  /* [rows] true node, each once per facet */
  PetscInt  *offset;    /* [num_facets] into T */
  PetscReal *T;
  PetscReal *B;           /* [as T] the same for the Bernstein functions */
  PetscReal *measure;     /* [rows] their integrals over the facet in the reference measure */
  PetscInt  *donor_first; /* [num_nodes+1] nodes that carry nothing: what the pressure there follows from, else empty */
  PetscInt  *donor;
  PetscReal *donor_weight; /* sum 1 at a node */
} ContactMultiplier;

/* Multiplier functions of a surface from its reference positions X (x is not looked at). carries[num_nodes] (NULL: all): the true node has a multiplier;
   late[num_nodes] (NULL: none): as in ContactPairSetCarriers. Not collective. */
PetscErrorCode ContactMultiplierCreate(const ContactSurface *, PetscBool axisymmetric, PetscBool standard, const PetscBool carries[], const PetscBool late[],
                                       ContactMultiplier **);
PetscErrorCode ContactMultiplierDestroy(ContactMultiplier **);

/* lattice.c: number of nodes of a facet's lattice; M[num][num] = int N_a N_b (NULL: not wanted), D[num] = int N_a of a facet in the reference measure. */
static inline PetscInt ContactLatticeSize(const ContactSurface *s, PetscInt facet)
{
  return ElementNumNodes(s->dim - 1, s->order ? s->order[facet] : 1);
}
PetscErrorCode ContactLatticeMass(const ContactSurface *, const FacetLattice *, PetscBool axisymmetric, PetscReal M[], PetscReal D[]);
/* B[k] = M^-1 B[k] for num vectors of n numbers one after another, by Cholesky with unit diagonal; M is overwritten. False: singular to 1e-10, B undefined. */
PetscErrorCode ContactSolveSymmetric(PetscInt n, PetscReal M[], PetscInt num, PetscReal B[], PetscBool *regular);

/* extrapolate.c: W[n][n], row e of a node that carries nothing: weights over the nodes that carry, sum 1; other rows are not touched. At least one carries.
   Facet on which nothing hangs: along lattice lines. */
PetscErrorCode ContactExtrapolateLattice(PetscInt dim, PetscInt order, PetscInt degree, const PetscBool carries[], PetscReal W[]);
/* Any set of n nodes of facets in space, by their reference positions. */
PetscErrorCode ContactExtrapolateNodes(const ContactSurface *, PetscInt num_facets, const PetscInt facets[], PetscInt degree, PetscInt n, const PetscInt node[],
                                       const PetscBool carries[], PetscReal W[]);

/* While the functions are made (multiplier.c). */
typedef struct {
  PetscInt   num, *node; /* rows, their true nodes */
  PetscReal *T, *B;      /* [num][lattice] */
} MultiplierRows;        /* of one facet */

typedef struct {
  PetscInt   num, *to, *from; /* node that carries nothing, node that got a share of its function; those of a node together */
  PetscReal *weight;
} MultiplierDonors; /* of facets whose functions are made together, with their first */

typedef struct {
  const ContactSurface *s;
  PetscBool             axisymmetric, standard;
  const PetscBool      *carries; /* [num_nodes] */
  const PetscBool      *late;    /* [num_nodes] or NULL */
  int                   round;   /* 0: functions of late nodes are still their own */
  PetscInt             *root;    /* [num_facets] ContactFacetGroups */
  PetscBool            *exact;   /* [num_facets] P^T psi_L */
  PetscInt             *place;   /* [num_nodes] -1; row of a true node in the group at hand */
  PetscReal            *weight;  /* [num_nodes] int psi_j */
  MultiplierRows       *rows;    /* [num_facets] */
  MultiplierDonors     *donors;  /* [num_facets] */
} MultiplierWork;

/* dual.c: rows of facets whose functions are made together, afresh, with these degrees for either round; held: some carry nothing. */
PetscErrorCode ContactMultiplierGroup(MultiplierWork *, PetscInt num_facets, const PetscInt facet[], const PetscInt degree[2], PetscBool *held);

/* donors.c: keeps the weights W[n][n] of extrapolate.c for n nodes; the weights of all facets, by nodes. */
PetscErrorCode ContactDonorsKeep(MultiplierDonors *, PetscInt n, const PetscInt node[], const PetscBool carries[], const PetscReal W[]);
PetscErrorCode ContactDonorsPack(const MultiplierWork *, ContactMultiplier *);

/* blend.c: what a facet of order p is to its functions and to its compliance when this share of it is covered; values and two derivatives by the share. */
typedef struct {
  PetscBool part; /* less than what counts as all of it */
  PetscReal theta[3], kappa[3];
} ContactShare;
/* Weight of a place of [-1, 1]^m in the share, integral 1, and derivatives 1 2, 11 12 22. */
void ContactShareWeight(PetscInt m, const PetscReal xi[2], PetscReal *v, PetscReal d[2], PetscReal dd[3]);
void ContactShareOf(PetscInt m, PetscInt order, PetscReal share, PetscBool across, ContactShare *);
/* The largest kappa, over all shares, of a facet that is not covered across an edge. */
PetscReal ContactShareMost(PetscInt order);
/* C[num][num]: Bernstein polynomial j of a facet in m dimensions by the functions of its lattice. */
PetscErrorCode ContactBernsteinRows(PetscInt m, PetscInt order, PetscReal C[]);
