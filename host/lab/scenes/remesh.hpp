// A closed triangle mesh whose edges are made equally long, and whose vertices are made so many.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "lab/scenes/flesh.hpp"

namespace clgi::generated {

// Splits long edges, collapses short ones, turns edges towards six neighbours a vertex and moves
// vertices to the middle of their neighbours, then back to the surface. [derived: Botsch and
// Kobbelt 2004] Every step keeps the mesh closed and its genus.
class Remesher {
public:
    using Project = std::function<glm::dvec3(const glm::dvec3&)>;  // to the surface

    Remesher(FleshMesh mesh, Project project);

    void even_out(double edge, int rounds);
    // Collapses the shortest edges or splits the longest until there are so many vertices.
    void reach(std::size_t vertices);
    void relax(int rounds);
    // Draws creases out until every triangle faces the way of its vertices' normals: where two
    // parts of the surface nearly touch, edges are too long to follow it.
    void iron();

    std::size_t vertices() const { return alive_; }
    double area() const;
    FleshMesh mesh() const;

private:
    using Triangle = TriangleCorners;

    bool has_edge(std::uint32_t a, std::uint32_t b) const;
    // The corner of the triangle that runs from a to b; none: nowhere.
    std::uint32_t opposite(std::uint32_t a, std::uint32_t b, std::size_t& triangle) const;
    double length(std::uint32_t a, std::uint32_t b) const;
    void detach(std::size_t triangle);
    void attach(std::size_t triangle, const Triangle& corners);
    std::vector<std::array<std::uint32_t, 2>> edges() const;
    glm::dvec3 cross_of(const Triangle& corners) const;
    glm::dvec3 normal(std::uint32_t v) const;  // mean of its triangles, weighted by area
    std::vector<std::uint32_t> neighbours(std::uint32_t v) const;

    glm::dvec3 middle(std::uint32_t v) const;  // of its neighbours

    bool collapse(std::uint32_t a, std::uint32_t b, double longest);
    void split(std::uint32_t a, std::uint32_t b);
    void flip_edges();

    std::vector<glm::dvec3> places_;
    std::vector<Triangle> triangles_;               // dead ones name nowhere
    std::vector<std::vector<std::size_t>> around_;  // triangles of each vertex; none: dead
    std::size_t alive_ = 0;
    Project project_;
};

}  // namespace clgi::generated
