// SPDX-License-Identifier: MIT
#include <clgi/mesh/simplify.hpp>

#include <meshoptimizer.h>

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <cmath>

#include "mesh/flip_edges.hpp"

namespace clgi::mesh {
namespace {

constexpr std::size_t fewest_triangles = 4;  // of a piece: a tetrahedron
constexpr float any_error = 10.0f;  // of the piece's size: the count decides, not the error

// A connected piece with vertices of its own.
struct Piece {
    std::vector<unsigned int> indices;    // into vertices
    std::vector<std::uint32_t> vertices;  // of the scene
};

// For every welded vertex one of the scene that has a triangle.
std::vector<std::uint32_t> representatives(const Scene& scene, const Adjacency& mesh) {
    std::vector<std::uint32_t> out(mesh.welded_count, no_index);
    for (const SceneTriangle& t : scene.triangles)
        for (const std::uint32_t vertex : t.vertex) {
            std::uint32_t& first = out[mesh.welded[vertex]];
            if (first == no_index) first = vertex;
        }
    return out;
}

std::vector<Piece> pieces(const Scene& scene, const Adjacency& mesh) {
    const std::vector<std::uint32_t> vertex_of = representatives(scene, mesh);
    std::vector<Piece> out(mesh.piece_count);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (mesh.pieces[t] == no_index) continue;
        for (const std::uint32_t vertex : scene.triangles[t].vertex)
            out[mesh.pieces[t]].vertices.push_back(vertex_of[mesh.welded[vertex]]);
    }
    std::vector<unsigned int> number(scene.positions.size());
    for (Piece& piece : out) {
        const std::vector<std::uint32_t> corners = piece.vertices;
        std::sort(piece.vertices.begin(), piece.vertices.end());
        piece.vertices.erase(std::unique(piece.vertices.begin(), piece.vertices.end()),
                             piece.vertices.end());
        for (std::size_t i = 0; i < piece.vertices.size(); ++i)
            number[piece.vertices[i]] = static_cast<unsigned int>(i);
        for (const std::uint32_t corner : corners) piece.indices.push_back(number[corner]);
    }
    return out;
}

// Positions as floats, from the middle of the piece.
std::vector<glm::vec3> local_positions(const Scene& scene, const Piece& piece) {
    glm::dvec3 low = scene.positions[piece.vertices[0]], high = low;
    for (const std::uint32_t v : piece.vertices) {
        low = glm::min(low, scene.positions[v]);
        high = glm::max(high, scene.positions[v]);
    }
    const glm::dvec3 middle = 0.5 * (low + high);
    const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    std::vector<glm::vec3> out;
    for (const std::uint32_t v : piece.vertices)
        out.emplace_back((scene.positions[v] - middle) / (size > 0.0 ? size : 1.0));
    return out;
}

// Of the surface around every vertex; 0 where it has none.
std::vector<glm::vec3> unit_normals(const std::vector<glm::vec3>& positions,
                                    const std::vector<unsigned int>& indices) {
    std::vector<glm::dvec3> sum(positions.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const glm::dvec3 a(positions[indices[i]]), b(positions[indices[i + 1]]),
            c(positions[indices[i + 2]]);
        for (std::size_t k = 0; k < 3; ++k) sum[indices[i + k]] += glm::cross(b - a, c - a);
    }
    std::vector<glm::vec3> out;
    for (const glm::dvec3& n : sum)
        out.emplace_back(glm::length(n) > 0.0 ? n / glm::length(n) : glm::dvec3(0.0));
    return out;
}

bool has_area(const Scene& scene, const glm::uvec3& t) {
    const glm::dvec3 &a = scene.positions[t.x], &b = scene.positions[t.y],
                     &c = scene.positions[t.z];
    return glm::cross(b - a, c - a) != glm::dvec3(0.0);
}

void append(const Scene& scene, Piece& piece, std::size_t triangles, std::vector<glm::uvec3>& out) {
    std::vector<unsigned int>& indices = piece.indices;
    if (indices.size() > 3 * triangles) {
        const std::vector<glm::vec3> positions = local_positions(scene, piece);
        std::vector<unsigned int> fewer(indices.size());
        fewer.resize(meshopt_simplify(fewer.data(), indices.data(), indices.size(), &positions[0].x,
                                      positions.size(), sizeof(glm::vec3), 3 * triangles,
                                      any_error));
        flip_edges(positions, unit_normals(positions, indices), fewer);
        indices.swap(fewer);
    }
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const glm::uvec3 t(piece.vertices[indices[i]], piece.vertices[indices[i + 1]],
                           piece.vertices[indices[i + 2]]);
        if (has_area(scene, t)) out.push_back(t);
    }
}

}  // namespace

std::vector<glm::uvec3> simplify(const Scene& scene, std::size_t triangles) {
    const Adjacency mesh = adjacency(scene);
    std::vector<Piece> all = pieces(scene, mesh);
    const double whole = static_cast<double>(scene.triangles.size() - mesh.degenerate);
    std::vector<glm::uvec3> out;
    for (Piece& piece : all) {
        const double share =
            static_cast<double>(triangles) * static_cast<double>(piece.indices.size() / 3) / whole;
        append(scene, piece,
               std::max(fewest_triangles, static_cast<std::size_t>(std::lround(share))), out);
    }
    return out;
}

}  // namespace clgi::mesh
