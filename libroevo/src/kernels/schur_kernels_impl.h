// Schur complements; what lanes_impl.h says of itself holds here.

constexpr int kQuad = 4;
typedef double Quad __attribute__((vector_size(8 * kQuad)));

/// A 6x6 block, column by column, is nine quads: in every third of them the rows are the same.
constexpr int kBlockQuads = 9, kRowQuads = 3;

void eliminatePoint(const double* coupling, const double* through, const std::int32_t* slot, int n,
                    int num_slots, double* blocks) {
    for (int c = 0; c < n; ++c) {
        Quad columns[kBlockQuads][3];  // two of six rows are three quads
        for (int k = 0; k < 3; ++k) {
            const double* six = coupling + 18 * c + 6 * k;
            for (int two = 0; two < 3; ++two) {
                const double first = six[2 * two], second = six[2 * two + 1];
                columns[3 * two][k] = Quad{first, first, first, first};
                columns[3 * two + 1][k] = Quad{first, first, second, second};
                columns[3 * two + 2][k] = Quad{second, second, second, second};
            }
        }
        for (int a = 0; a <= c; ++a) {
            Quad rows[kRowQuads][3];
            for (int k = 0; k < 3; ++k) {
                const double* six = through + 18 * a + 6 * k;
                rows[0][k] = load<Quad>(six);
                rows[1][k] = Quad{six[4], six[5], six[0], six[1]};
                rows[2][k] = load<Quad>(six + 2);
            }
            double* block = blocks + 36 * (std::ptrdiff_t{slot[a]} * num_slots + slot[c]);
            for (int j = 0; j < kBlockQuads; ++j) {
                const Quad* row = rows[j % kRowQuads];
                const Quad product = row[0] * columns[j][0] + row[1] * columns[j][1] + row[2] * columns[j][2];
                store(block + kQuad * j, load<Quad>(block + kQuad * j) - product);
            }
        }
    }
}
