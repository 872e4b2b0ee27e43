/* Elimination of a block of unknowns uses all equations with coefficients in it. The singular value decomposition of these columns gives the
 * independent equations, which determine a part of the block for given neighbours; the others remain as equations of the neighbours. The
 * undetermined part of the block minimizes the sum of squares, which leaves equations of the neighbours, too. Products of rows with each
 * other, whose condition number is squared, are never formed.
 *
 * Remaining rows are stored with the block that they come from, and are gathered by its parent: the neighbour that is eliminated
 * first. The order has little fill: the cost of chains, trees and rows of loops is proportional to their size.
 */
#include "equations.h"

#include <string.h>

#include "../../workspace.h"
#include "../../zerodrift.h"
#include "../small.h"
#include "blocks.h"

#include "../small.h"

static const double RANK = 1e-9;        /* relative to rows of length one: bound of redundant ones */

enum kind { MET, SQUARED, KINDS };

/* Rows that a block passes to its parent: (rows, width), or has (rows, size + width) while it is eliminated */
typedef struct passed {
    int rows, most;
    double *x;
} passed;

typedef struct block {
    int at, size;           /* in the unknowns */
    int width;              /* unknowns of its neighbours, and the right side */
    int neighbours;
    const int *neighbour;   /* (neighbours,): places, increasing; the first is the parent */
    int first_row, child, sibling;      /* rows without entries in blocks eliminated before; -1: none */
    passed passed[KINDS];
    double *of;             /* (size, width): the block is the last column minus the others times the neighbours */
} block;

typedef struct elimination {
    const zd_sparse_equations *equations;
    zd_ordering ordering;
    void *memory;
    block *block;           /* (blocks,), in the order of elimination */
    int *next_row;          /* (rows,) of the same block; -1: none */
    int *column;            /* (unknowns,): column of each in the gathered rows */
    double *gathered[KINDS];    /* (most rows, most columns) */
    double *V, *sigma, *work;   /* (size, size), (size,), (most columns,) of one block */
} elimination;

/* ---- the order ---- */

/* Distinct blocks of a row, in the order of its columns; returns their number. */
static int blocks_of(const zd_sparse_equations *equations, const zd_sparse_row *row, int *member)
{
    int count = 0, last = -1;
    for (int j = 0; j < row->count; j++) {
        const int b = equations->block_of[row->column ? row->column[j] : j];
        if (b != last) member[count++] = last = b;
    }
    return count;
}

static int find_order(elimination *self)
{
    const zd_sparse_equations *of = self->equations;
    size_t members = 0;
    for (int k = 0; k < of->rows; k++) members += of->row[k].count;
    int *numbers = zd_allocate(((size_t)of->rows + 2 + members + (size_t)of->blocks) * sizeof(int));
    if (!numbers) return 0;
    int *begin = numbers, *member = begin + of->rows + 1, *size = member + members, cliques = 0;
    for (int k = 0; k < of->rows; k++) {
        if (!of->row[k].count || (k && of->row[k].column == of->row[k - 1].column)) continue;
        begin[cliques + 1] = begin[cliques] + blocks_of(of, of->row + k, member + begin[cliques]);
        cliques++;
    }
    for (int b = 0; b < of->blocks; b++) size[b] = of->at[b + 1] - of->at[b];
    const zd_pattern pattern = {.count = of->blocks, .size = size, .cliques = cliques, .begin = begin, .member = member};
    const int is_found = zd_ordering_find(&pattern, NULL, &self->ordering);
    zd_release(numbers);
    return is_found;
}

/* ---- memory ---- */

static void describe_blocks(elimination *self)
{
    const zd_sparse_equations *of = self->equations;
    const zd_ordering *ordering = &self->ordering;
    for (int b = 0; b < of->blocks; b++) {
        const int i = ordering->place[b], begin = ordering->begin[i];
        self->block[i] = (block){.at = of->at[b], .size = of->at[b + 1] - of->at[b], .width = 1, .neighbour = ordering->row + begin,
                                 .neighbours = ordering->begin[i + 1] - begin, .first_row = -1, .child = -1, .sibling = -1};
    }
    for (int i = 0; i < of->blocks; i++)
        for (int j = 0; j < self->block[i].neighbours; j++) self->block[i].width += ordering->size[self->block[i].neighbour[j]];
    for (int i = of->blocks - 1; i >= 0; i--) {
        if (!self->block[i].neighbours) continue;
        block *parent = self->block + self->block[i].neighbour[0];
        self->block[i].sibling = parent->child;
        parent->child = i;
    }
}

/* Assigns each row to the first of its blocks. */
static void assign_rows(elimination *self)
{
    const zd_sparse_equations *of = self->equations;
    for (int k = of->rows - 1; k >= 0; k--) {
        int first = of->blocks;
        for (int j = 0; j < of->row[k].count; j++) {
            const int place = self->ordering.place[of->block_of[of->row[k].column ? of->row[k].column[j] : j]];
            first = place < first ? place : first;
        }
        if (first == of->blocks) continue;
        self->next_row[k] = self->block[first].first_row;
        self->block[first].first_row = k;
        self->block[first].passed[of->is_square[k] ? SQUARED : MET].most++;
    }
}

/* Bounds of the numbers of equations in each block, and remaining after it; most (KINDS,) <- entries of the largest gathered matrices */
static void count_rows(elimination *self, size_t *most)
{
    for (int i = 0; i < self->equations->blocks; i++) {
        block *b = self->block + i;
        for (int kind = 0; kind < KINDS; kind++) {
            int rows = b->passed[kind].most + (kind == SQUARED ? b->size : 0);
            for (int child = b->child; child >= 0; child = self->block[child].sibling) rows += self->block[child].passed[kind].most;
            const size_t entries = (size_t)rows * (b->size + b->width);
            most[kind] = entries > most[kind] ? entries : most[kind];
            const int passable = kind == MET ? b->size + b->width : b->width;
            b->passed[kind].most = b->width == 1 ? 0 : rows < passable ? rows : passable;
        }
    }
}

static void create_matrices(zd_arena *arena, elimination *self, const size_t *most)
{
    int size = 0, columns = 0;
    for (int i = 0; i < self->equations->blocks; i++) {
        block *b = self->block + i;
        for (int kind = 0; kind < KINDS; kind++)
            b->passed[kind].x = zd_arena_doubles(arena, (size_t)b->passed[kind].most * b->width);
        b->of = zd_arena_doubles(arena, (size_t)b->size * b->width);
        size = b->size > size ? b->size : size;
        columns = b->size + b->width > columns ? b->size + b->width : columns;
    }
    for (int kind = 0; kind < KINDS; kind++) self->gathered[kind] = zd_arena_doubles(arena, most[kind]);
    self->V = zd_arena_doubles(arena, (size_t)size * size);
    self->sigma = zd_arena_doubles(arena, size);
    self->work = zd_arena_doubles(arena, columns);
}

static void create_lists(zd_arena *arena, elimination *self)
{
    const zd_sparse_equations *of = self->equations;
    self->block = zd_arena_bytes(arena, of->blocks * sizeof *self->block);
    self->next_row = zd_arena_ints(arena, of->rows);
    self->column = zd_arena_ints(arena, of->at[of->blocks]);
}

/* Memory of the lists first, as they tell the sizes of the matrices */
static int prepare(elimination *self, void **lists)
{
    size_t most[KINDS] = {0};
    zd_arena arena = {0};
    create_lists(&arena, self);
    arena = (zd_arena){.base = *lists = zd_allocate(arena.used)};
    if (!arena.base || !find_order(self)) return 0;
    create_lists(&arena, self);
    describe_blocks(self);
    assign_rows(self);
    count_rows(self, most);
    arena = (zd_arena){0};
    create_matrices(&arena, self, most);
    arena = (zd_arena){.base = self->memory = zd_allocate(arena.used)};
    if (!arena.base) return 0;
    create_matrices(&arena, self, most);
    return 1;
}

/* ---- elimination ---- */

static void set_columns(elimination *self, const block *b)
{
    int column = 0;
    for (int j = 0; j < b->size; j++) self->column[b->at + j] = column++;
    for (int i = 0; i < b->neighbours; i++) {
        const block *other = self->block + b->neighbour[i];
        for (int j = 0; j < other->size; j++) self->column[other->at + j] = column++;
    }
}

static void gather_row(const elimination *self, int k, double *to, int right)
{
    const zd_sparse_equations *of = self->equations;
    const zd_sparse_row *row = of->row + k;
    for (int j = 0; j < row->count; j++) {
        const int i = row->column ? row->column[j] : j;
        to[self->column[i]] = of->factor[k] * (of->weight ? row->x[j] / of->weight[i] : row->x[j]);
    }
    to[right] = of->factor[k] * of->right[k];
}

static void gather_passed(const elimination *self, const block *child, enum kind kind, double *to, int columns)
{
    const double *from = child->passed[kind].x;
    for (int k = 0; k < child->passed[kind].rows; k++, to += columns) {
        for (int i = 0; i < child->neighbours; i++) {
            const block *other = self->block + child->neighbour[i];
            const int at = self->column[other->at];
            for (int j = 0; j < other->size; j++) to[at + j] = *from++;
        }
        to[columns - 1] = *from++;
    }
}

/* All rows of a kind that touch a block, its columns first, reduced to a triangle; returns their number. */
static int gather(elimination *self, const block *b, enum kind kind)
{
    const int columns = b->size + b->width;
    double *to = self->gathered[kind];
    int rows = kind == SQUARED ? b->size : 0;
    for (int k = b->first_row; k >= 0; k = self->next_row[k]) rows += self->equations->is_square[k] == (kind == SQUARED);
    for (int i = b->child; i >= 0; i = self->block[i].sibling) rows += self->block[i].passed[kind].rows;
    memset(to, 0, (size_t)rows * columns * sizeof *to);
    rows = 0;
    for (; kind == SQUARED && rows < b->size; rows++) to[rows * columns + rows] = 1;
    for (int k = b->first_row; k >= 0; k = self->next_row[k])
        if (self->equations->is_square[k] == (kind == SQUARED)) gather_row(self, k, to + rows++ * columns, columns - 1);
    for (int i = b->child; i >= 0; i = self->block[i].sibling) {
        gather_passed(self, self->block + i, kind, to + rows * columns, columns);
        rows += self->block[i].passed[kind].rows;
    }
    return rows > columns && kind == MET ? zd_triangulate(rows, columns, columns, to, self->work) : rows;
}

/* Stores rows from `first` on, of those that are gathered, that have an entry above `least`, from column `from` on. */
static void pass(const elimination *self, block *b, enum kind kind, int first, int rows, int from, double least)
{
    const int columns = b->size + b->width;
    passed *to = b->passed + kind;
    to->rows = 0;
    for (int k = first; b->width > 1 && k < rows && to->rows < to->most; k++) {
        const double *row = self->gathered[kind] + k * columns + from;
        if (zd_largest(b->width - 1, row) > least) zd_copy_all(b->width, row, to->x + to->rows++ * b->width);
    }
}

/* The first `rank` rows of b->of <- the part of the block along V that required rows determine; returns the rank. */
static int determine(elimination *self, block *b)
{
    const int columns = b->size + b->width, rows = gather(self, b, MET);
    double *A = self->gathered[MET];
    zd_orthogonalize_columns(rows, b->size, columns, A, self->V, self->sigma);
    int rank = 0;
    while (rank < b->size && rank < rows && self->sigma[rank] > RANK) rank++;
    for (int k = 0; k < rank; k++) {
        zd_reflect_column(rows - k, columns - k, columns, A + k * (columns + 1), self->work);
        for (int j = 0; j < b->width; j++) b->of[k * b->width + j] = A[k * columns + b->size + j] / A[k * columns + k];
    }
    pass(self, b, MET, rank, rows, b->size, RANK);
    return rank;
}

/* The other rows of b->of <- the part that minimizes the sum of squares */
static void minimize(elimination *self, block *b, int rank)
{
    const int n = b->size, columns = n + b->width;
    double *A = self->gathered[SQUARED], *turned = self->sigma;
    int rows = gather(self, b, SQUARED);
    for (int k = 0; k < rows; k++) {
        double *row = A + k * columns;
        zd_clear(n, turned);
        for (int j = 0; j < n; j++) zd_add_scaled(n, turned, row[j], self->V + j * n);
        zd_copy_all(n, turned, row);
        for (int i = 0; i < rank; i++) zd_add_scaled(b->width, row + n, -turned[i], b->of + i * b->width);
    }
    rows = zd_triangulate(rows, columns - rank, columns, A + rank, self->work);
    for (int i = n - rank - 1; i >= 0; i--) {
        const double *row = A + i * columns + rank;
        double *to = b->of + (rank + i) * b->width;
        zd_copy_all(b->width, A + i * columns + n, to);
        for (int j = i + 1; j < n - rank; j++) zd_add_scaled(b->width, to, -row[j], b->of + (rank + j) * b->width);
        for (int j = 0; j < b->width; j++) to[j] /= row[i];
    }
    pass(self, b, SQUARED, n - rank, rows, n, 0);
}

/* b->of <- V b->of */
static void turn_back(const elimination *self, block *b)
{
    for (int j = 0; j < b->width; j++) {
        for (int i = 0; i < b->size; i++) self->sigma[i] = b->of[i * b->width + j];
        for (int i = 0; i < b->size; i++) b->of[i * b->width + j] = zd_dot(b->size, self->V + i * b->size, self->sigma);
    }
}

static void eliminate(elimination *self, block *b)
{
    set_columns(self, b);
    minimize(self, b, determine(self, b));
    turn_back(self, b);
}

/* x <- this block, from its neighbours */
static void substitute(const elimination *self, const block *b, double *x)
{
    const double *of = b->of;
    for (int i = 0; i < b->size; i++) {
        double sum = 0;
        for (int k = 0; k < b->neighbours; k++) {
            const block *other = self->block + b->neighbour[k];
            sum -= zd_dot(other->size, of, x + other->at);
            of += other->size;
        }
        x[b->at + i] = sum + *of++;
    }
}

int zd_minimum_norm(const zd_sparse_equations *equations, double *x)
{
    elimination self = {.equations = equations};
    void *lists = NULL;
    const int is_prepared = prepare(&self, &lists), n = equations->at[equations->blocks];
    for (int i = 0; is_prepared && i < equations->blocks; i++) eliminate(&self, self.block + i);
    for (int i = equations->blocks - 1; is_prepared && i >= 0; i--) substitute(&self, self.block + i, x);
    for (int i = 0; equations->weight && i < n; i++) x[i] /= equations->weight[i];
    zd_ordering_free(&self.ordering);
    zd_release(self.memory);
    zd_release(lists);
    return is_prepared ? ZD_DONE : ZD_NO_MEMORY;
}
